#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc render: its files, signals, and the same image whatever the number of threads."""

import json
import os
import pty
import re
import resource
import signal
import subprocess
import time

import _h2mc


class Render(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def render(self, output, *arguments):
        return self.succeeds("render", "scene.xml", "-o", output, *arguments)

    @staticmethod
    def budget(integrator):
        return "--samples-per-pixel" if integrator in _h2mc.SAMPLERS else "--mutations-per-pixel"

    def test_default_output(self):
        os.mkdir(self.path("work"))
        result = subprocess.run([_h2mc.BINARY, "render", "../scene.xml", "-i", "path",
                                 "--samples-per-pixel", "1"],
                                cwd=self.path("work"), capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(os.listdir(self.path("work")), ["scene.exr"])

    def test_attributes_and_statistics(self):
        for integrator in _h2mc.INTEGRATORS:
            with self.subTest(integrator):
                result = self.render("a.exr", "-i", _h2mc.quick(integrator, "maxDepth=4"), "--seed", "17",
                                     "--threads", "2", self.budget(integrator), "8",
                                     "-D", "width=20", "--stats", "a.json")
                self.assertEqual(result.stdout, "")
                self.assertIn("mean luminance", result.stderr)
                attributes, _ = self.read_exr("a.exr")
                self.assertEqual(attributes["scene"], "scene.xml")
                self.assertEqual(attributes["integrator"], integrator)
                self.assertRegex(attributes["integratorOptions"], r"(^|,)maxDepth=4(,|$)")
                self.assertEqual(attributes["seed"], "17")
                self.assertEqual(attributes["threads"], 2)
                self.assertGreater(attributes["wallSeconds"], 0)
                self.assertGreater(attributes["cpuSeconds"], 0)
                # How long tours are is left to chance.
                least = 0.7 if integrator in ("erpt", "restore") else 1
                self.assertGreaterEqual(attributes["samples"], least * 8 * 20 * 16)
                self.assertGreater(attributes["meanLuminance"], 0)
                self.assertGreater(attributes["meanLuminanceError"], 0)
                self.assertRegex(attributes["programVersion"], r"^\d+\.\d+\.\d+")
                with open(self.path("a.json"), encoding="utf-8") as stream:
                    statistics = json.load(stream)
                self.assertEqual(statistics["integrator"], integrator)
                self.assertEqual(statistics["width"], 20)
                self.assertEqual(statistics["samples"], attributes["samples"])
                self.assertIsInstance(statistics["statistics"], dict)

    def test_beams(self):
        """Path tracing says that it misses their light; the others don't."""
        self.write("scene.xml", _h2mc.SCENE.replace("</scene>", '<emitter type="collimated"/></scene>'))
        for integrator in ("path", "bdpt", "mmlt"):
            result = self.render("out.exr", "-i", integrator, self.budget(integrator), "1")
            self.assertEqual("light of collimated emitters" in result.stderr, integrator == "path", integrator)

    def test_formats(self):
        self.render("a.exr", "-i", "path", "--samples-per-pixel", 4, "--png")
        self.render("b.hdr", "-i", "path", "--samples-per-pixel", 4)
        self.render("c.png", "-i", "path", "--samples-per-pixel", 4, "--png")
        self.assertEqual(self.files(), ["a.exr", "a.png", "b.hdr", "c.png", "scene.xml"])
        self.succeeds("diff", "a.png", "c.png", "--metric", "mse", "--tolerance", "0")
        self.succeeds("diff", "a.exr", "b.hdr", "--metric", "mse", "--tolerance", "1e-3")
        with open(self.path("a.png"), "rb") as a, open(self.path("c.png"), "rb") as c:
            self.assertEqual(a.read(), c.read())

    def test_size(self):
        self.render("a.exr", "-i", "path", "--samples-per-pixel", 1, "--scale", "0.5")
        self.fails(2, "diff", "a.exr", self.write_png("b.png", 5, 3, lambda x, y: (0, 0, 0)),
                   says="12 x 8")
        self.render("a.exr", "-i", "path", "--samples-per-pixel", 1, "--width", 7, "--height", 5)
        self.fails(2, "diff", "a.exr", "b.png", says="7 x 5")

    def test_quiet(self):
        result = self.render("a.exr", "-i", "path", "--samples-per-pixel", 1, "--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_time(self):
        start = time.monotonic()
        self.render("a.exr", "-i", _h2mc.quick("h2mc"), "--time", "1")
        self.assertLess(time.monotonic() - start, 20)
        self.assertGreater(self.read_exr("a.exr")[0]["samples"], 0)

    def test_same_seed_same_file(self):
        for integrator in _h2mc.INTEGRATORS:
            with self.subTest(integrator):
                for threads in (1, 2):
                    self.render(f"{threads}.exr", "-i", _h2mc.quick(integrator), "--threads", threads,
                                "--seed", 5, self.budget(integrator), 16)
                self.render("other.exr", "-i", _h2mc.quick(integrator), "--seed", 6, self.budget(integrator), 16)
                self.assertEqual(self.picture("1.exr"), self.picture("2.exr"))
                self.assertNotEqual(self.picture("1.exr")[1], self.picture("other.exr")[1])

    def start(self, *arguments, **streams):
        process = subprocess.Popen(
            [_h2mc.BINARY, "render", "scene.xml", "-o", "a.exr", "--time", "600", *arguments],
            cwd=self.folder, stdin=subprocess.DEVNULL, text=True, **streams)
        self.addCleanup(process.kill)
        return process

    def test_interrupted(self):
        for integrator, number in (("path", signal.SIGINT), ("h2mc", signal.SIGTERM),
                                   ("bdpt", signal.SIGHUP), ("mmlt", signal.SIGINT)):
            with self.subTest(integrator):
                process = self.start("-i", _h2mc.quick(integrator), "--stats", "a.json",
                                     stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                # The first line of progress: it renders now.
                while not re.search(r" left$", line := process.stderr.readline()):
                    self.assertNotEqual(line, "", "it ended before it was interrupted")
                process.send_signal(number)
                output, messages = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 130, messages)
                self.assertEqual(output, "")
                self.assertEqual(self.files(), ["a.exr", "a.json", "scene.xml"])
                attributes, _ = self.read_exr("a.exr")
                self.assertEqual(attributes["interrupted"], 1)
                self.assertGreater(attributes["meanLuminance"], 0)
                os.remove(self.path("a.exr"))
                os.remove(self.path("a.json"))

    # Ctrl-C twice within 10 ms is one wish, and a picture is there as soon as a signal no longer ends the program by
    # itself, however early.
    def test_interrupted_at_once_and_twice(self):
        for integrator in ("path", "bdpt", "mmlt", "h2mc:directSamples=0"):
            with self.subTest(integrator):
                process = self.start("-i", integrator, "--width", "2000", "--height", "1500", stderr=subprocess.PIPE)
                _h2mc.wait_for_handler(process)
                process.send_signal(signal.SIGINT)
                time.sleep(0.01)
                process.send_signal(signal.SIGTERM)
                _, messages = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 130, messages)
                self.assertEqual(self.files(), ["a.exr", "scene.xml"])
                attributes, _ = self.read_exr("a.exr")
                self.assertEqual(attributes["interrupted"], 1)
                self.assertGreater(attributes["samples"], 0)
                self.assertGreater(attributes["meanLuminance"], 0)
                os.remove(self.path("a.exr"))

    def test_nohup(self):
        process = subprocess.Popen(["nohup", _h2mc.BINARY, "render", "scene.xml", "-o", "a.exr", "--time", "2", "-q"],
                                   cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        _h2mc.wait_for_handler(process)
        process.send_signal(signal.SIGHUP)
        self.assertEqual(process.wait(60), 0)
        self.assertEqual(self.read_exr("a.exr")[0]["interrupted"], 0)

    # Minutes of samples that place the chains: these end too, and the image is whole.
    def test_interrupted_before_the_chains_begin(self):
        process = self.start("-i", "mmlt:bootstrapSamples=20000000,directSamples=1", stderr=subprocess.PIPE)
        _h2mc.wait_for_handler(process)
        time.sleep(2)
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130, messages)
        attributes, _ = self.read_exr("a.exr")
        self.assertEqual(attributes["interrupted"], 1)
        self.assertGreater(attributes["meanLuminance"], 0)

    # Lines, and not many of them, where stderr is no terminal.
    def test_plain_progress(self):
        process = self.start("-i", "path", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(7)
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate(timeout=60)
        self.assertNotIn("\r", messages)
        progress = re.findall(r"(?m)^ *\d+ %.* left$", messages)
        self.assertIn(len(progress), (1, 2), messages)

    def test_bar_on_a_terminal(self):
        ours, theirs = pty.openpty()
        environment = dict(os.environ, TERM="xterm")
        process = self.start("-i", "path", stderr=theirs, env=environment)
        _h2mc.wait_for_handler(process)
        time.sleep(3)
        process.send_signal(signal.SIGINT)
        process.wait(timeout=60)
        os.close(theirs)
        text = b""
        try:
            while chunk := os.read(ours, 65536):
                text += chunk
        except OSError:
            pass  # the other end is closed
        os.close(ours)
        self.assertIn(b"\r[", text)
        self.assertRegex(text.decode(), r"samples/s +\d.* left")


class FullDisk(_h2mc.Test):
    def test_the_old_file_stays(self):
        """No file may grow beyond 1000 bytes, as on a full disk: exit code 3, the old file stays, nothing is left."""
        self.write("scene.xml", _h2mc.SCENE)
        for name in ("a.exr", "a.png", "a.hdr"):
            with self.subTest(name):
                self.write(name, "old")

                def limit():
                    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))

                result = subprocess.run([_h2mc.BINARY, "render", "scene.xml", "-o", name, "-q", "-s", "1", "-i", "path",
                                         "--width", "64", "--height", "48"], cwd=self.folder, capture_output=True,
                                        text=True, check=False, preexec_fn=limit)
                self.assertEqual(result.returncode, 3, result.stderr)
                self.assertRegex(result.stderr, f'^h2mc: cannot write "{name}": ')
                with open(self.path(name), encoding="utf-8") as stream:
                    self.assertEqual(stream.read(), "old")
                os.remove(self.path(name))
                self.assertEqual(self.files(), ["scene.xml"])


if __name__ == "__main__":
    _h2mc.main()
