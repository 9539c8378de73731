#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc render --aov: layers beside the picture, and what other commands make of files that have some."""

import os
import sys

import _h2mc

sys.path.insert(0, os.path.join(_h2mc.SOURCE_DIR, "scenes"))
import exr  # noqa: E402  (what the scenes' scripts share)

CHANNELS = {"albedo": "RGB", "normal": "XYZ", "depth": "Z", "position": "XYZ", "time": "X", "id": "X",
            "variance": "RGB", "mutations": "X"}
ALL = ",".join(CHANNELS)


class Aov(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def render(self, name, *more, integrator="path", budget=4):
        option = "-s" if integrator in _h2mc.SAMPLERS else "-m"
        self.succeeds("render", "scene.xml", "-i", _h2mc.quick(integrator), option, budget, "-o", name, "-q", *more)
        return name

    def planes(self, name):
        _, width, height, planes = exr.read_planes(self.path(name))
        self.assertEqual((width, height), (24, 16))
        return planes

    def test_all_layers(self):
        self.render("plain.exr", "--seed", 3)
        plain = self.planes("plain.exr")
        self.assertEqual(sorted(plain), ["B", "G", "R"])
        for integrator in ("path", "h2mc"):
            with self.subTest(integrator):
                self.render("a.exr", "--seed", 3, "--aov", ALL, integrator=integrator)
                planes = self.planes("a.exr")
                self.assertEqual(set(planes), {"R", "G", "B"} | {f"{layer}.{channel}" for layer, channels
                                                                 in CHANNELS.items() for channel in channels})
                if integrator == "path":  # and the picture is what it is without them
                    for channel in "RGB":
                        self.assertEqual(planes[channel], plain[channel])
                    self.assertEqual(planes["mutations.X"], [4] * (24 * 16))
                work = self.read_exr("a.exr")[0]["samples"]
                self.assertAlmostEqual(sum(planes["mutations.X"]), work, delta=1e-4 * work)
                # The grey ball in the middle, and the floor before it, which is the first shape.
                middle, floor = 8 * 24 + 12, 15 * 24 + 12
                self.assertEqual(planes["id.X"][middle], 3)
                self.assertEqual(planes["id.X"][floor], 1)
                self.assertAlmostEqual(planes["albedo.G"][middle], 0.5, 5)
                self.assertAlmostEqual(planes["normal.Y"][floor], 1, 5)
                self.assertAlmostEqual(planes["position.Y"][floor], 0, 4)
                self.assertAlmostEqual(planes["depth.Z"][middle], 5 - planes["position.Z"][middle], 3)
                self.assertGreater(sum(planes["variance.G"]), 0)

    def test_whatever_the_threads(self):
        for integrator in ("bdpt", "h2mc"):
            one = self.picture(self.render("a.exr", "--aov", ALL, "--threads", 1, integrator=integrator))
            three = self.picture(self.render("b.exr", "--aov", ALL, "--threads", 3, integrator=integrator))
            self.assertEqual(one, three)
        again = self.planes(self.render("c.exr", "--aov", "albedo", "--seed", 1))
        self.assertNotEqual(again["R"], self.planes("b.exr")["R"])

    def test_resume(self):
        keep = ("--checkpoint", "a.state", "-o", "a.exr", "--aov", "variance,mutations,depth")
        self.render("whole.exr", "--aov", "variance,mutations,depth", integrator="h2mc", budget=30)
        self.succeeds("render", "scene.xml", "-i", _h2mc.quick("path"), "-s", 5, *keep)
        self.succeeds("render", "scene.xml", "-i", _h2mc.quick("path"), "-s", 9, *keep, "--resume")
        self.render("b.exr", "--aov", "variance,mutations,depth", budget=9)
        self.assertEqual(self.planes("a.exr"), self.planes("b.exr"))
        # One that has no variances, or has others than it is to go on with, is refused.
        self.fails(2, "render", "scene.xml", "-i", "path", "-s", 12, "--checkpoint", "a.state", "-o", "a.exr",
                   "--resume", says="layers is variance,mutations there and none here")
        self.fails(2, "render", "scene.xml", "-i", "path", "-s", 12, "--checkpoint", "a.state", "-o", "a.exr",
                   "--resume", "--aov", "variance", says="layers is variance,mutations there and variance here")

    def test_mistakes(self):
        self.fails(2, "render", "scene.xml", "--aov", "albdeo", says=('"albdeo"', 'did you mean "albedo"'))
        self.fails(2, "render", "scene.xml", "--aov", "", says="--aov")
        self.fails(2, "render", "scene.xml", "--aov", "albedo", "-o", "a.png", says=("--aov", "EXR", "a.png"))
        self.fails(2, "render", "scene.xml", "--aov", "albedo", "--aov-samples", 0, says="--aov-samples")

    def test_diff_takes_the_picture(self):
        self.render("a.exr", "--aov", ALL)
        self.render("b.exr")
        result = self.succeeds("diff", "a.exr", "b.exr", "--metric", "mse", "--tolerance", 0)
        self.assertRegex(result.stdout, r"(?m)^mse +0$")

    def test_info(self):
        self.render("a.exr", "--aov", "albedo,depth", "--crop", "4,2,16,10")
        text = self.succeeds("info", "a.exr").stdout
        for words in ("16 x 10", "from (4, 2) on of 24 x 16", "albedo, depth", "albedo.R", "scene.xml",
                      "programVersion"):
            self.assertIn(words, text)
        self.write("b.exr", "no EXR")
        self.fails(2, "info", "b.exr", says="b.exr")

    def test_merge(self):
        names = [self.render(f"{seed}.exr", "--seed", seed, "--aov", ALL, budget=budget)
                 for seed, budget in ((1, 4), (2, 12))]
        self.assertNotIn("left out", self.succeeds("merge", *names, "-o", "all.exr").stderr)
        one, other, merged = (self.planes(name) for name in (*names, "all.exr"))
        for channel in merged:
            layer = channel.split(".")[0]
            for a, b, found in zip(one[channel], other[channel], merged[channel], strict=True):
                if layer == "mutations":
                    self.assertEqual(found, a + b)
                elif layer == "variance":
                    self.assertAlmostEqual(found, a / 16 + b * 9 / 16, delta=1e-5 * (1e-3 + found))
                elif layer in CHANNELS:
                    self.assertEqual(found, a)
                else:
                    self.assertAlmostEqual(found, a / 4 + b * 3 / 4, delta=1e-5 * (1 + found))
        # What not all of them have is left out, and said to be.
        self.render("3.exr", "--seed", 3, "--aov", "albedo,mutations")
        result = self.succeeds("merge", *names, "3.exr", "-o", "all.exr")
        self.assertIn("layers left out, as not all images have them or they are not h2mc's: variance\n", result.stderr)
        self.assertNotIn("variance.R", self.planes("all.exr"))
        self.assertIn("normal.X", self.planes("all.exr"))
        self.assertIn("layers left out: albedo", self.succeeds("merge", *names, "-o", "all.hdr").stderr)


if __name__ == "__main__":
    _h2mc.main()
