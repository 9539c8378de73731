#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Options that are wrong end with exit code 2, one message, and no file."""

import os
import re
import subprocess
import unittest

import _h2mc


class General(_h2mc.Test):
    def test_version(self):
        self.assertRegex(self.succeeds("--version").stdout, r"^h2mc \d+\.\d+\.\d+")

    def test_help(self):
        text = self.succeeds("--help").stdout
        for command in ("render", "rerender", "info", "list", "diff", "gradcheck", "stress", "compare", "demo",
                        "inspect", "merge", "convert", "completion", "man"):
            self.assertIn(command, text)
            self.assertIn("-h", self.succeeds(command, "--help").stdout)
        for option in ("--output", "--integrator", "--time", "--samples-per-pixel",
                       "--mutations-per-pixel", "--seed", "--threads", "--width", "--height",
                       "--scale", "-D", "--stats", "--quiet", "--png"):
            self.assertIn(option, self.succeeds("render", "--help").stdout)

    def test_misspelt_option(self):
        self.fails(2, "render", "scene.xml", "--thread", 2, says=("--thread", 'did you mean "--threads"'))
        self.fails(2, "compare", "scene.xml", "-o", "x", "--repaets=2", says=("--repaets", 'did you mean "--repeats"'))
        # One of a group.
        self.fails(2, "render", "scene.xml", "--tme", 2, says=("--tme", 'did you mean "--time"'))

    def test_threads_and_seed(self):
        for command in ("render", "inspect", "gradcheck", "stress"):
            for bad in ("0", "-1", "1.5", "1025", "100000", "x", ""):
                self.fails(2, command, "scene.xml", "--threads", bad, says=("--threads", "from 1 to 1024", f'"{bad}"'))
            for bad in ("-1", "1.5", "18446744073709551616", "x", ""):
                self.fails(2, command, "scene.xml", "--seed", bad, says=("--seed", "18446744073709551615", f'"{bad}"'))

    def test_full_stdout(self):
        self.write("scene.xml", _h2mc.SCENE)
        self.write_png("a.png", 4, 4, lambda x, y: (9, 9, 9))
        for arguments in (["--version"], ["--help"], ["render", "--help"], ["list"], ["info", "scene.xml"],
                          ["completion", "bash"], ["man", "render"],
                          ["diff", "a.png", "a.png"], ["gradcheck", "scene.xml", "--paths", 50],
                          ["compare", "scene.xml", "-i", "path", "-m", 1, "--repeats", 1, "-o", "out"]):
            with self.subTest(arguments), open("/dev/full", "w", encoding="ascii") as full:
                result = subprocess.run([_h2mc.BINARY, *map(str, arguments)], cwd=self.folder, stdout=full,
                                        stderr=subprocess.PIPE, text=True, check=False)
                self.assertEqual(result.returncode, 3, result.stderr)
                self.assertEqual(len(re.findall(r"(?m)^h2mc: cannot write", result.stderr)), 1, result.stderr)

    def test_commands(self):
        self.fails(2)
        self.fails(2, "reender", says="reender")
        self.fails(2, "--nonsense", says="--nonsense")
        for command in ("render", "info", "diff"):
            self.fails(2, command, says=f"h2mc {command} --help")


class Render(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def test_budget(self):
        self.fails(2, "render", "scene.xml", "--time", 1, "--samples-per-pixel", 1, says="--time")
        self.fails(2, "render", "scene.xml", "--samples-per-pixel", 1, "--mutations-per-pixel", 1,
                   says="--mutations-per-pixel")
        for bad in ("0", "-1", "nan", "inf", "abc", "", "1x"):
            self.fails(2, "render", "scene.xml", "--time", bad, says="--time")
        for option in ("--samples-per-pixel", "--mutations-per-pixel", "--threads", "--width",
                       "--scale"):
            for bad in ("0", "abc"):
                self.fails(2, "render", "scene.xml", option, bad, says=option)
        self.fails(2, "render", "scene.xml", "--samples-per-pixel", "1.5")

    def test_integrator(self):
        self.fails(2, "render", "scene.xml", "-i", "pathh", says=("pathh", *_h2mc.INTEGRATORS))
        self.fails(2, "render", "scene.xml", "-i", "path:maxDepht=3", says=("maxDepht", "maxDepth"))
        self.fails(2, "render", "scene.xml", "-i", "path:maxDepth=deep", says="maxDepth")
        self.fails(2, "render", "scene.xml", "-i", "path:maxDepth", says="option=value")
        self.fails(2, "render", "scene.xml", "-i", "path:=3", says="option=value")

    def test_depths(self):
        self.fails(2, "render", "scene.xml", "-i", "path:minDepth=3,maxDepth=2",
                   says="minDepth 3 is above maxDepth 2: there are no paths")
        self.assertEqual(self.files(), ["scene.xml"])
        result = self.succeeds("render", "scene.xml", "-i", "path:maxDepth=33", "-s", 1, "-o", "a.exr")
        self.assertIn("maxDepth 33 is above what the renderer goes to: paths have at most 32 edges", result.stderr)
        self.assertIn("maxDepth=32", self.read_exr("a.exr")[0]["integratorOptions"])

    def test_size(self):
        self.fails(2, "render", "scene.xml", "--scale", 2, "--width", 5, says="--scale")

    def test_seed_and_defines(self):
        self.fails(2, "render", "scene.xml", "--seed", "-1", says="--seed")
        self.fails(2, "render", "scene.xml", "--seed", "x", says="--seed")
        self.fails(2, "render", "scene.xml", "-D", "width", says="name=value")
        self.fails(2, "render", "scene.xml", "-D", "=5", says="name=value")

    # Found out before the scene is read: it is not there, and the message is about the output.
    def test_outputs_come_first(self):
        self.fails(2, "render", "none.xml", "-o", "image.tga", says=("image.tga", ".exr"))
        self.fails(2, "render", "none.xml", "-o", "image", says="image")
        self.fails(2, "render", "none.xml", "-o", "nowhere/image.exr", says="nowhere")
        self.fails(2, "render", "none.xml", "-o", "/dev/null", says="/dev/null")
        self.fails(2, "render", "none.xml", "--stats", "nowhere/stats.json", says="nowhere")
        os.mkdir(self.path("folder.exr"))
        self.fails(2, "render", "none.xml", "-o", "folder.exr", says="folder.exr")

    def test_outputs_are_other_files(self):
        self.write("a.exr", "")
        os.symlink(self.path("a.exr"), self.path("link.json"))
        self.fails(2, "render", "scene.xml", "-o", "a.exr", "--stats", "a.exr", says=("the image", "--stats"))
        self.fails(2, "render", "scene.xml", "-o", "a.exr", "--stats", "link.json", says=("the image", "--stats"))
        self.fails(2, "render", "scene.xml", "-o", "a.exr", "--stats", "./scene.xml", says=("the scene", "--stats"))
        self.fails(2, "render", "scene.exr", "-o", "scene.exr", says=("the scene", "the image"))
        for command in (["gradcheck"], ["stress"], ["inspect", "--pixel", "1,1"]):
            self.fails(2, *command, "scene.xml", "--json", "scene.xml", says=("the scene", "--json"))
        self.write_png("a.png", 4, 4, lambda x, y: (9, 9, 9))
        self.fails(2, "diff", "a.png", "a.png", "-o", "a.png", says=("read", "the difference picture"))
        self.fails(2, "demo", "image-copy", "a.png", "-o", "a.png", says=("the picture", "the page"))

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_protected_outputs(self):
        os.mkdir(self.path("closed"))
        os.chmod(self.path("closed"), 0o500)
        self.fails(2, "render", "none.xml", "-o", "closed/image.exr", says="closed")
        self.write("old.exr", "")
        os.chmod(self.path("old.exr"), 0o400)
        self.fails(2, "render", "none.xml", "-o", "old.exr", says="old.exr")

    def test_scene(self):
        for command in ("render", "info"):
            self.fails(2, command, "none.xml", says="none.xml")
            self.write("bad.xml", "<scene version='0.6.0'>\n  <shape type='rectangel'/>\n</scene>\n")
            self.fails(2, command, "bad.xml", says=("bad.xml", "rectangel", "rectangle"))
            self.write("bad.xml", "<scene version='0.6.0'>\n")
            self.fails(2, command, "bad.xml", says="bad.xml")


if __name__ == "__main__":
    _h2mc.main()
