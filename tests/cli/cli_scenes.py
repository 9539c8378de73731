#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The project's own scenes: they load, they are complete, and their generators write the committed files."""

import filecmp
import glob
import os
import re
import shutil
import subprocess
import sys

import _h2mc

SCENES = os.path.join(_h2mc.SOURCE_DIR, "scenes")
NAMES = sorted(name for name in os.listdir(SCENES)
               if os.path.exists(os.path.join(SCENES, name, name + ".xml")))
MEGABYTE = 1 << 20


class Scenes(_h2mc.Test):
    def test_all_load(self):
        self.assertGreater(len(NAMES), 10)
        for name in NAMES:
            text = self.succeeds("info", os.path.join(SCENES, name, name + ".xml")).stdout
            self.assertIn("h2mc:maxDepth=", text, name)
            self.assertNotIn("\nnote ", text, name)
            moves = not re.search(r"(?m)^moving +no$", text)
            self.assertEqual(moves, name in ("cars", "spinning"), name)

    def test_each_is_complete(self):
        for name in NAMES:
            folder = os.path.join(SCENES, name)
            with open(os.path.join(folder, "README.md"), encoding="utf-8") as stream:
                readme = stream.read()
            reference = re.search(r"(?m)^Reference integrator: `(\w+)`", readme)
            self.assertTrue(reference and reference[1] in _h2mc.INTEGRATORS, name)
            command = re.search(rf"scripts/make-reference.py scenes/{name}/{name}.xml -i (\S+) ", readme)
            self.assertTrue(command and command[1].split(":")[0] == reference[1], name)
            self.assertTrue(os.path.exists(os.path.join(folder, name + ".png")), name)
            windows = []
            for file in ("reference.exr", "reference_stderr.exr"):
                attributes, _ = self.read_exr(os.path.join(folder, file))
                self.assertEqual(attributes["integrator"], command[1], name)
                windows.append(attributes["dataWindow"])
            self.assertEqual(windows[0], windows[1], name)

    def test_generators_write_what_is_committed(self):
        # Beside copies of the scripts, so that nothing is written into the source.
        shutil.copy(os.path.join(SCENES, "geometry.py"), self.folder)
        for script in sorted(glob.glob(os.path.join(SCENES, "*", "make_*.py"))):
            source = os.path.dirname(script)
            copy = self.path(os.path.basename(source))
            os.mkdir(copy)
            shutil.copy(script, copy)
            subprocess.run([sys.executable, os.path.join(copy, os.path.basename(script))], check=True,
                           timeout=120)
            made = sorted(set(os.listdir(copy)) - {os.path.basename(script), "__pycache__"})
            there = sorted(os.path.basename(path) for kind in ("ply", "hdr")
                           for path in glob.glob(os.path.join(source, "*." + kind)))
            self.assertEqual(made, there, script)
            for file in made:
                self.assertTrue(filecmp.cmp(os.path.join(copy, file), os.path.join(source, file),
                                            shallow=False),
                                f"{script} does not write {file} as it is")

    def test_they_are_small(self):
        sizes = [os.path.getsize(os.path.join(folder, file)) for folder, _, files in os.walk(SCENES)
                 for file in files if not file.endswith(".pyc")]
        self.assertLess(sum(sizes), 10 * MEGABYTE)
        self.assertLess(max(sizes), MEGABYTE)


if __name__ == "__main__":
    _h2mc.main()
