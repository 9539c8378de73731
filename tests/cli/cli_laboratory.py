#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/laboratory.py: its tables, and ratios between what is the same."""

import os
import subprocess

import _h2mc

SCRIPT = os.path.join(_h2mc.SOURCE_DIR, "scripts", "laboratory.py")
PYTHON = "/usr/bin/python3"  # for which Debian's NumPy is


class Laboratory(_h2mc.Test):
    def setUp(self):
        super().setUp()
        if subprocess.run([PYTHON, "-c", "import numpy"], capture_output=True, check=False).returncode:
            self.skipTest("Debian's python3-numpy is not installed")

    def laboratory(self, *options):
        return subprocess.run([PYTHON, SCRIPT, "--program", _h2mc.BINARY, "--scene", "cornell", *options],
                              capture_output=True, text=True, check=False)

    def test_a_program_against_itself(self):
        result = self.laboratory("--program", _h2mc.BINARY, "--mutations", "2", "--seeds", "2", "--method",
                                 "mmlt:bootstrapSamples=2000", "--store", self.path("all.json"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("| 2.0 |", result.stdout)
        self.assertIn("correlation 1 px", result.stdout)
        stored = self.report("all.json")["cornell"]
        (first,) = stored.values()  # of one name
        self.assertEqual([run["seed"] for run in first], [1, 2])
        for run in first:
            self.assertEqual(len(run["relMSE"]), 4)
            self.assertEqual(sorted(run["relMSE"], reverse=True), run["relMSE"])
            self.assertAlmostEqual(run["meanRatio"], 1, delta=0.2)
            self.assertIn("states", run["statistics"]["noise"])

    def test_mistakes(self):
        for options, words in [(["--scene", "nowhere"], "nowhere"), (["--width", "77"], "77")]:
            result = self.laboratory("--mutations", "1", "--seeds", "1", *options)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(words, result.stderr)


if __name__ == "__main__":
    _h2mc.main()
