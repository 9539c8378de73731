#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders that are ended in every way, and go on."""

import os
import random
import re
import signal
import subprocess
import time

import _h2mc


class Resume(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def arguments(self, integrator, budget, *more):
        option = "-s" if integrator in _h2mc.SAMPLERS else "-m"
        return ["render", "scene.xml", "-i", _h2mc.quick(integrator), option, budget, *more]

    def interrupt(self, command, seconds=0, until=lambda: True):
        """Ctrl-C after so many seconds, and not before until() is true."""
        process = subprocess.Popen([_h2mc.BINARY, *map(str, command)], cwd=self.folder, stderr=subprocess.PIPE,
                                   text=True)
        self.addCleanup(process.kill)
        _h2mc.wait_for_handler(process)
        time.sleep(seconds)
        late = time.monotonic() + 60
        while not until() and time.monotonic() < late:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate(timeout=60)
        return process.returncode, messages

    def test_ctrl_c(self):
        command = self.arguments("h2mc", 20000, "-o", "a.exr", "--checkpoint", "a.state", "--every", 0.2)
        code, messages = self.interrupt(command, 1)
        self.assertEqual(code, 130, messages)
        self.assertIn('--resume goes on from "a.state"', messages)
        first = self.picture("a.exr")[0]["samples"]
        # However busy the machine is: once it has saved several times what it went on to.
        saved = set()

        def went_on():
            saved.add(os.stat(self.path("a.state")).st_mtime_ns)
            return len(saved) > 4

        code, messages = self.interrupt([*command, "--resume"], until=went_on)
        self.assertEqual(code, 130, messages)
        self.assertGreater(self.picture("a.exr")[0]["samples"], first)

    # Nobody has asked for a checkpoint: there is one where the render was long, and it goes when the render is whole.
    def test_by_itself(self):
        command = self.arguments("path", 100000, "-o", "a.exr", "--every", 0.2)
        code, messages = self.interrupt(command, 1)
        self.assertEqual(code, 130, messages)
        self.assertEqual(self.files(), ["a.checkpoint", "a.exr", "scene.xml"])
        samples = self.picture("a.exr")[0]["samples"] / (24 * 16)
        # Another render does not go on from it unless it is asked to, and says so.
        result = self.succeeds(*self.arguments("path", 2, "-o", "a.exr"))
        self.assertIn('"a.checkpoint" is there: --resume would go on from it', result.stderr)
        self.succeeds(*self.arguments("path", int(samples) + 50, "-o", "a.exr", "--resume"))
        self.assertEqual(self.files(), ["a.exr", "scene.xml"])
        self.assertGreaterEqual(self.picture("a.exr")[0]["samples"] / (24 * 16), samples)

    def test_more_onto_a_finished_render(self):
        for name in ("bdpt", "photon"):
            keep = ("-o", f"{name}.exr", "--checkpoint", f"{name}.state")
            self.succeeds(*self.arguments(name, 8, *keep))
            result = self.succeeds(*self.arguments(name, 20, *keep, "--resume"))
            self.assertNotIn("from the beginning", result.stderr)
            self.succeeds(*self.arguments(name, 20, "-o", "b.exr"))
            self.assertEqual(self.picture(f"{name}.exr"), self.picture("b.exr"))

    def test_nothing_to_go_on_from(self):
        result = self.succeeds(*self.arguments("path", 2, "-o", "a.exr", "--resume"))
        self.assertIn('there is no checkpoint "a.checkpoint": from the beginning', result.stderr)

    def test_other_renders_are_refused(self):
        keep = ("-o", "a.exr", "--checkpoint", "a.state")
        self.succeeds(*self.arguments("path", 2, *keep, "--seed", 3))
        again = (*keep, "--resume")
        self.fails(2, *self.arguments("path", 4, *again, "--seed", 4), says=("a.state", "seed is 3 there and 4 here"))
        self.fails(2, *self.arguments("bdpt", 4, *again, "--seed", 3), says="integrator is path there and bdpt here")
        self.fails(2, "render", "scene.xml", "-i", "path:maxDepth=3", "-s", 4, *again, "--seed", 3,
                   says="option maxDepth is -1 there and 3 here")
        self.fails(2, *self.arguments("path", 4, *again, "--seed", 3, "--width", 30), says="width is 24 there and 30")
        self.fails(2, *self.arguments("path", 4, *again, "--seed", 3, "-D", "radiance=5"),
                   says="-D radiance is missing there and 5 here")
        self.fails(2, *self.arguments("path", 4, *again, "--seed", 3, "--permissive"), says="permissive is false there")
        defined = ("-o", "b.exr", "--checkpoint", "b.state", "--seed", 3)
        self.succeeds(*self.arguments("path", 2, *defined, "-D", "radiance=4"))
        self.fails(2, *self.arguments("path", 4, *defined, "--resume"), says="-D radiance is 4 there and missing here")
        self.fails(2, *self.arguments("path", 4, *defined, "--resume", "-D", "radiance=5"),
                   says="-D radiance is 4 there and 5 here")
        self.succeeds(*self.arguments("path", 4, *defined, "--resume", "-D", "radiance=4"))
        self.write("scene.xml", _h2mc.SCENE.replace("0.5, 0.5, 0.5", "0.6, 0.5, 0.5"))
        self.fails(2, *self.arguments("path", 4, *again, "--seed", 3), says='"scene.xml" has changed')

    # One byte another, or fewer of them, wherever that is.
    def test_damage(self):
        command = self.arguments("mmlt", 8, "-o", "a.exr", "--checkpoint", "a.state")
        self.succeeds(*command)
        with open(self.path("a.state"), "rb") as stream:
            state = stream.read()
        places = random.Random(3)
        for place in (0, 9, 40, len(state) - 1, *(places.randrange(len(state)) for _ in range(6))):
            for broken in (state[:place], state[:place] + bytes([state[place] ^ 16]) + state[place + 1:]):
                with open(self.path("a.state"), "wb") as stream:
                    stream.write(broken)
                self.fails(2, *command, "--resume", says='the checkpoint "a.state"')
        os.remove(self.path("a.state"))
        os.mkdir(self.path("a.state"))
        self.fails(2, *command, "--resume", says="a.state")

    def test_it_is_another_file(self):
        for other in ("scene.xml", "a.exr", "a.json"):
            self.fails(2, *self.arguments("path", 2, "-o", "a.exr", "--stats", "a.json", "--checkpoint", other),
                       says=("are one file", other))

    # Images on the way are whole, and grow.
    def test_save_every(self):
        process = subprocess.Popen([_h2mc.BINARY, *map(str, self.arguments("h2mc", 100000, "-o", "a.exr", "--png",
                                                                           "--save-every", 0.2))],
                                   cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        seen = set()
        end = time.monotonic() + 60
        while len(seen) < 3 and time.monotonic() < end:
            if os.path.exists(self.path("a.exr")):
                seen.add(self.picture("a.exr")[0]["samples"])
            time.sleep(0.05)
        self.assertEqual(len(seen), 3)
        process.kill()
        process.communicate()
        self.assertIn("a.png", self.files())

    # What can't be written is said, and the render goes on.
    def test_no_room(self):
        os.mkdir(self.path("full"))
        result = subprocess.run(["bash", "-c", "ulimit -f 5; exec \"$@\"", "-", _h2mc.BINARY,
                                 *map(str, self.arguments("path", 3000, "-o", "a.png", "--checkpoint", "a.state",
                                                          "--every", 0.1))],
                                cwd=self.folder, capture_output=True, text=True, check=False,
                                preexec_fn=lambda: signal.signal(signal.SIGXFSZ, signal.SIG_IGN))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, r'cannot write "a.state": writing failed')
        self.assertTrue(re.search(r"a\.png", " ".join(self.files())))
        self.assertNotIn("a.state", self.files())


if __name__ == "__main__":
    _h2mc.main()
