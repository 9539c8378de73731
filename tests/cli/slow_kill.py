#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders that are killed, and go on."""

import os
import random
import subprocess
import time

import _h2mc

BUDGETS = {"path": 8000, "bdpt": 2000, "photon": 1500, "mmlt": 5000, "h2mc": 3000, "lmc": 3000, "rjmlt": 4000,
           "mlt": 2500, "pssmlt": 1500, "remlt": 2500, "erpt": 3000, "restore": 3000}


class Kill(_h2mc.Test):
    # Killed at random moments, again and again, until it is through, with another number of threads each time: the
    # picture is that of a render to which nothing has happened.
    def test_kill_9(self):
        self.write("scene.xml", _h2mc.SCENE)
        moments = random.Random(7)
        kills = 0
        self.assertEqual(set(BUDGETS), set(_h2mc.INTEGRATORS))
        for integrator, budget in BUDGETS.items():
            with self.subTest(integrator):
                command = [_h2mc.BINARY, "render", "scene.xml", "-q", "-i", _h2mc.quick(integrator),
                           "-s" if integrator in _h2mc.SAMPLERS else "-m", str(budget), "-o"]
                began = time.monotonic()
                subprocess.run([*command, "whole.exr"], cwd=self.folder, check=True)
                whole = time.monotonic() - began
                kills += self.render_and_kill([*command, "a.exr"], moments, whole)
                self.assertEqual(self.picture("a.exr"), self.picture("whole.exr"))
                self.assertEqual(self.files(), ["a.exr", "a.state", "scene.xml", "whole.exr"])
                os.remove(self.path("a.state"))
                os.remove(self.path("a.exr"))
        print("killed", kills, "times")
        self.assertGreaterEqual(kills, 10)  # fifty on an idle machine

    def render_and_kill(self, command, moments, whole):
        """Returns how many times it was killed."""
        command = [*command, "--checkpoint", "a.state", "--every", "0.05", "--resume", "--threads"]
        for attempt in range(300):
            process = subprocess.Popen([*command, str(1 + attempt % 3)], cwd=self.folder)
            try:
                # Later and later, should the machine have become slow.
                process.communicate(timeout=whole * (0.03 + 0.25 * moments.random()) * (1 + attempt / 16))
                self.assertEqual(process.returncode, 0)
                return attempt
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
        self.fail("it never ends")


if __name__ == "__main__":
    _h2mc.main()
