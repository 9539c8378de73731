#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Watching a render: --display in a viewer, --serve for a browser. The picture is the same, whoever looks on."""

import http.client
import json
import os
import signal
import socket
import subprocess
import time

import _h2mc
import _tev


class Live(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def begin(self, *arguments):
        process = subprocess.Popen([_h2mc.BINARY, "render", "scene.xml", "-i", _h2mc.quick("h2mc"),
                                    *map(str, arguments)], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def end(self, process, code=0):
        _, messages = process.communicate(timeout=200)
        self.assertEqual(process.returncode, code, messages)
        return messages

    def same_picture(self, *arguments):
        """A render with these options gives the bytes of one without."""
        self.succeeds("render", "scene.xml", "-i", _h2mc.quick("h2mc"), "-m", 800, "-o", "alone.exr")
        self.end(self.begin("-m", 800, "-o", "watched.exr", *arguments))
        alone, watched = self.picture("alone.exr"), self.picture("watched.exr")
        self.assertEqual(alone[1], watched[1])
        self.assertEqual(alone[0], watched[0])


class Display(Live):
    def viewer(self, port=0):
        viewer = _tev.Viewer(port).start()
        self.addCleanup(viewer.close)
        return viewer

    def test_picture(self):
        viewer = self.viewer()
        self.end(self.begin("-t", 3, "-o", "a.exr", "--display", f"127.0.0.1:{viewer.port}"))
        self.assertEqual(viewer.problems, [])
        self.assertEqual(viewer.connections, 1)
        self.assertEqual(list(viewer.images), ["a.exr"])
        self.assertEqual(viewer.images["a.exr"]["size"], (24, 16))
        self.assertEqual(viewer.images["a.exr"]["channels"], ["R", "G", "B"])
        self.assertGreater(viewer.updates, 1)  # on the way too
        self.assertEqual(viewer.images["a.exr"]["rows"], self.pixel_rows("a.exr"))

    # More rows than a packet has.
    def test_large_picture(self):
        viewer = self.viewer()
        self.end(self.begin("-m", 1, "-o", "a.exr", "--width", 700, "--height", 400, "--display",
                            f"localhost:{viewer.port}"))
        self.assertEqual(viewer.problems, [])
        self.assertGreater(viewer.updates, 1)
        rows = viewer.images["a.exr"]["rows"]
        self.assertEqual((len(rows), len(rows[399])), (400, 700))
        self.assertEqual(rows, self.pixel_rows("a.exr"))

    def test_same_picture(self):
        viewer = self.viewer()
        self.same_picture("--display", f"127.0.0.1:{viewer.port}")
        self.assertGreater(viewer.updates, 0)

    def test_nobody_listens(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
        messages = self.end(self.begin("-t", 1, "-o", "a.exr", "--display", f"127.0.0.1:{port}"))
        self.assertEqual(messages.count("--display"), 1, messages)
        self.assertIn(f"127.0.0.1:{port}: Connection refused; the render goes on", messages)
        self.assertIn("a.exr", self.files())

    # One that is started later is found.
    def test_later_viewer(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
        process = self.begin("-t", 15, "-o", "a.exr", "--display", f"127.0.0.1:{port}")
        time.sleep(1)
        viewer = self.viewer(port)
        self.end(process)
        self.assertGreater(viewer.updates, 0)
        self.assertEqual(viewer.images["a.exr"]["rows"], self.pixel_rows("a.exr"))

    def test_viewer_that_closes(self):
        viewer = self.viewer()
        process = self.begin("-t", 5, "-o", "a.exr", "--display", f"127.0.0.1:{viewer.port}")
        self.assertTrue(viewer.came.wait(30))
        viewer.close()
        messages = self.end(process)
        self.assertIn("the viewer has gone; the render goes on", messages)
        self.assertGreater(self.picture("a.exr")[0]["samples"], 0)

    # It is connected to, and never reads.
    def test_viewer_that_stalls(self):
        with socket.create_server(("127.0.0.1", 0), backlog=8) as listener:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            self.end(self.begin(
                "-t", 2, "-o", "a.exr", "--width", 640, "--height", 480, "--display",
                f"127.0.0.1:{listener.getsockname()[1]}"))
        self.assertLess(self.read_exr("a.exr")[0]["wallSeconds"], 20)  # of 2, on however busy a machine

    def test_wrong_addresses(self):
        for bad in ("127.0.0.1", "here:", ":14158", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:x", "::1:80"):
            self.fails(2, "render", "scene.xml", "--display", bad, says=("--display", "HOST:PORT", f'"{bad}"'))
        self.fails(2, "render", "scene.xml", "--display", "no.such.host.invalid:14158",
                   says=("--display", "no.such.host.invalid"))


class Serve(Live):
    def begin(self, *arguments):
        process = super().begin(*arguments)
        messages = ""
        self.port = 0
        for line in process.stderr:
            messages += line
            if "to be watched at http://127.0.0.1:" in line:
                self.port = int(line.rsplit(":", 1)[1].strip().rstrip("/"))
                break
        if "made without cpp-httplib" in messages:
            self.skipTest("this build serves no pages: it was made without libcpp-httplib-dev")
        self.assertGreater(self.port, 0, messages)
        return process

    def ask(self, path, method="GET", headers=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        try:
            connection.request(method, path, headers=headers or {})
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def state(self, until=lambda state: True, seen=0):
        late = time.monotonic() + 200
        while time.monotonic() < late:
            state = json.loads(self.ask(f"/state?seen={seen}")[1])
            if until(state):
                return state
            time.sleep(0.1)
        self.fail(f"never came: {state}")
        return None

    def test_news(self):
        process = self.begin("-t", 12, "-o", "a.exr", "--serve", 0)
        late = time.monotonic() + 200
        page = b""
        while b"a.exr" not in page and time.monotonic() < late:  # until the scene has been read
            status, page = self.ask("/")
            self.assertEqual(status, 200)
        self.assertIn(b"a.exr", page)
        first = self.state(lambda state: state["number"] > 0 and state["rate"] and state["acceptance"])
        self.assertEqual((first["width"], first["height"]), (24, 16))
        self.assertFalse(first["over"])
        self.assertGreater(first["meanLuminance"], 0)
        kinds = {kind["name"]: kind["acceptance"] for kind in first["acceptance"]}
        self.assertIn("hamiltonian", kinds)
        for acceptance in kinds.values():
            self.assertTrue(0 <= acceptance <= 1, kinds)
        self.assertEqual(len(first["pixels"]["data"]), 24 * 16 * 3 * 2 * 4 // 3)
        self.assertEqual(len(first["error"]["data"]), 24 * 16 * 2 * 4 // 3)
        # What was seen is not sent again; later there are newer ones.
        number = first["number"]
        again = self.state(seen=number)
        self.assertEqual("pixels" in again, again["number"] != number)
        later = self.state(lambda state: state["number"] > number, seen=number)
        self.assertGreater(later["samples"], first["samples"])
        self.assertGreater(later["fraction"], first["fraction"])
        last = self.state(lambda state: state["over"])
        self.assertTrue(last["written"])
        self.assertFalse(last["interrupted"])
        self.end(process)

    def test_same_picture(self):
        self.same_picture("--serve", 0)

    def test_stop(self):
        process = self.begin("-t", 600, "-o", "a.exr", "--serve", 0)
        self.state(lambda state: state["number"] > 0)
        # A page of another origin can't send the header, and one whose name was made to mean this machine is seen
        # through.
        self.assertEqual(self.ask("/stop", "POST")[0], 403)
        self.assertEqual(self.ask("/stop", "POST", {"X-H2mc": "stop", "Host": "evil.example"})[0], 403)
        self.assertEqual(self.ask("/state", headers={"Host": "evil.example"})[0], 403)
        self.assertNotEqual(self.ask("/stop", headers={"X-H2mc": "stop"})[0], 200)
        self.assertIsNone(process.poll())
        self.assertFalse(self.state()["stopping"])
        self.assertEqual(self.ask("/stop", "POST", {"X-H2mc": "stop", "Host": "localhost:9"})[0], 200)
        self.state(lambda state: state["over"] and state["interrupted"] and state["written"])
        self.end(process, 130)
        self.assertEqual(self.read_exr("a.exr")[0]["interrupted"], 1)

    def test_only_here(self):
        self.begin("-t", 600, "-o", "a.exr", "--serve", 0)
        with open("/proc/net/tcp", encoding="ascii") as table:
            listening = [line.split()[1] for line in table if line.split()[3] == "0A"]
        self.assertIn(f"0100007F:{self.port:04X}", listening)
        self.assertNotIn(f"00000000:{self.port:04X}", listening)

    def test_port_that_is_taken(self):
        self.begin("-t", 600, "-o", "a.exr", "--serve", 0)
        self.fails(2, "render", "scene.xml", "-o", "b.exr", "--serve", self.port,
                   says=(f"--serve {self.port}", "Address already in use"))
        for bad in ("-1", "65536", "x"):
            self.fails(2, "render", "scene.xml", "--serve", bad, says="--serve")

    # Somebody who asks for everything and reads nothing.
    def test_browser_that_stalls(self):
        process = self.begin("-t", 3, "-o", "a.exr", "--width", 640, "--height", 480, "--serve", 0)
        stalled = []
        for _ in range(8):
            connection = socket.create_connection(("127.0.0.1", self.port))
            self.addCleanup(connection.close)
            connection.sendall(b"GET /state?seen=0 HTTP/1.1\r\nHost: localhost\r\n\r\n")
            stalled.append(connection)
        self.end(process)
        self.assertLess(self.read_exr("a.exr")[0]["wallSeconds"], 20)

    # The variance that the page shows is kept by a checkpoint, with which it goes on watched or not.
    def test_resume(self):
        keep = ("-o", "a.exr", "--checkpoint", "a.state", "--every", 0.2)
        for serve, more in (((), ("--serve", 0)), (("--serve", 0), ())):
            with self.subTest(serve=serve):
                process = (self.begin if serve else super().begin)("-m", 100000000, *keep, *serve)
                late = time.monotonic() + 200
                while not os.path.exists(self.path("a.state")) and time.monotonic() < late:
                    time.sleep(0.1)
                process.send_signal(signal.SIGINT)
                self.end(process, 130)
                before = self.read_exr("a.exr")[0]["samples"]
                process = (self.begin if more else super().begin)("-m", 100000000, *keep, *more, "--resume")
                time.sleep(1)
                if more:
                    self.assertNotIn("error", self.state(lambda state: state["number"] > 0))
                process.send_signal(signal.SIGINT)
                self.end(process, 130)
                self.assertGreaterEqual(self.read_exr("a.exr")[0]["samples"], before)
                os.remove(self.path("a.state"))


if __name__ == "__main__":
    _h2mc.main()
