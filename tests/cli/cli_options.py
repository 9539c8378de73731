#!/usr/bin/env python3
"""Options that are wrong end with exit code 2, one message, and no file."""

import os
import unittest

import _h2mc


class General(_h2mc.Test):
    def test_version(self):
        self.assertRegex(self.succeeds("--version").stdout, r"^h2mc \d+\.\d+\.\d+")

    def test_help(self):
        text = self.succeeds("--help").stdout
        for command in ("render", "info", "list", "diff", "gradcheck", "stress", "compare", "demo", "inspect"):
            self.assertIn(command, text)
            self.assertIn("-h", self.succeeds(command, "--help").stdout)
        for option in ("--output", "--integrator", "--time", "--samples-per-pixel",
                       "--mutations-per-pixel", "--seed", "--threads", "--width", "--height",
                       "--scale", "-D", "--stats", "--quiet", "--png"):
            self.assertIn(option, self.succeeds("render", "--help").stdout)

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
