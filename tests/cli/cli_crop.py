#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc render --crop: a window of the picture, where it lies in it, and what it shows."""

import os
import struct
import sys

import _h2mc

sys.path.insert(0, os.path.join(_h2mc.SOURCE_DIR, "scenes"))
import exr  # noqa: E402  (what the scenes' scripts share)

# By the film itself: 24 x 16 pixels, of which 16 x 12 from (4, 2) on.
CROPPED = _h2mc.SCENE.replace('<rfilter type="box"/>', '<rfilter type="box"/>'
                              '<integer name="cropOffsetX" value="4"/><integer name="cropOffsetY" value="2"/>'
                              '<integer name="cropWidth" value="16"/><integer name="cropHeight" value="12"/>')


class Crop(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)
        self.write("cropped.xml", CROPPED)

    def render(self, name, *more, scene="scene.xml", budget=4):
        self.succeeds("render", scene, "-i", "path", "-s", budget, "-o", name, "-q", *more)
        return name

    def windows(self, name):
        """(data window, display window), each as (x, y, width, height)."""
        attributes = exr.read(self.path(name))[0]

        def window(kind):
            x0, y0, x1, y1 = struct.unpack("<4i", attributes[kind])
            return x0, y0, x1 - x0 + 1, y1 - y0 + 1
        return window("dataWindow"), window("displayWindow")

    def test_is_what_the_film_crop_is(self):
        self.render("film.exr", scene="cropped.xml")
        self.render("line.exr", "--crop", "4,2,16,12")
        self.assertEqual(exr.read(self.path("film.exr"))[3], exr.read(self.path("line.exr"))[3])
        for name in ("film.exr", "line.exr"):
            self.assertEqual(self.windows(name), ((4, 2, 16, 12), (0, 0, 24, 16)))
        self.render("whole.exr")
        self.assertEqual(self.windows("whole.exr"), ((0, 0, 24, 16), (0, 0, 24, 16)))

    def test_a_window_of_a_window(self):
        self.render("a.exr", "--crop", "2,1,5,6", scene="cropped.xml")
        self.assertEqual(self.windows("a.exr"), ((6, 3, 5, 6), (0, 0, 24, 16)))
        self.render("b.exr", "--crop", "6,3,5,6")
        for a, b in zip(exr.read(self.path("a.exr"))[3], exr.read(self.path("b.exr"))[3], strict=True):
            for one, other in zip(a, b, strict=True):
                self.assertAlmostEqual(one, other, delta=1e-3)
        # Pixels are those of the size that is asked for.
        self.render("c.exr", "--scale", 2, "--crop", "8,4,32,24")
        self.assertEqual(self.windows("c.exr"), ((8, 4, 32, 24), (0, 0, 48, 32)))
        self.render("d.exr", "--scale", 2, scene="cropped.xml")
        self.assertEqual(self.windows("d.exr"), ((8, 4, 32, 24), (0, 0, 48, 32)))

    # The same part of the scene: by the layer of positions, where no light is in the way.
    def test_shows_the_window(self):
        self.render("whole.exr", "--aov", "position", "--aov-samples", 64)
        self.render("part.exr", "--aov", "position", "--aov-samples", 64, "--crop", "5,3,9,8")
        whole, part = (exr.read_planes(self.path(name))[3] for name in ("whole.exr", "part.exr"))
        for channel in ("position.X", "position.Z"):
            for y in range(1, 7):
                for x in range(1, 8):
                    self.assertAlmostEqual(part[channel][y * 9 + x], whole[channel][(y + 3) * 24 + x + 5], delta=0.15)
        self.assertNotAlmostEqual(part["position.X"][1 * 9 + 1], whole["position.X"][1 * 24 + 1], delta=0.15)

    def test_against_the_whole(self):
        """h2mc diff compares a window with the same part of a whole reference, whichever comes first."""
        self.render("whole.exr")
        self.render("part.exr", "--crop", "5,3,9,8")
        whole, part = (exr.read(self.path(name))[3] for name in ("whole.exr", "part.exr"))
        cut = [[plane[(y + 3) * 24 + x + 5] for y in range(8) for x in range(9)] for plane in whole]
        mse = sum((a - b) ** 2 for p, q in zip(part, cut, strict=True) for a, b in zip(p, q, strict=True)) / (3 * 72)
        for first, second in ("part.exr", "whole.exr"), ("whole.exr", "part.exr"):
            result = self.succeeds("diff", first, second, "--metric", "mse")
            self.assertIn("from (5, 3) on is compared, 9 x 8", result.stderr)
            self.assertAlmostEqual(float(result.stdout.split()[1]) / mse, 1, 4)
        # Other windows, and those of another size.
        self.render("other.exr", "--crop", "4,3,9,8")
        self.fails(2, "diff", "part.exr", "other.exr", says=("different windows", "(5, 3)", "(4, 3)"))
        self.render("large.exr", "--scale", 2, "--crop", "5,3,9,8")
        self.fails(2, "diff", "large.exr", "whole.exr", says=("differ in size", "9 x 8", "24 x 16"))

    def test_mistakes(self):
        for bad in ("1,2,3", "1,2,3,4,5", "a,b,c,d", "1,2,0,4", "-1,2,3,4", "1, 2, 3, 4", "", "1,2,3,4x"):
            self.fails(2, "render", "scene.xml", f"--crop={bad}", says=("--crop", "X,Y,W,H"))
        for outside in ("20,0,5,5", "0,12,5,5", "0,0,25,16", "2147483647,0,2147483647,1"):
            self.fails(2, "render", "scene.xml", "--crop", outside, says=("is not within the image", "24 x 16"))

    def test_others_are_not_mixed_in(self):
        self.render("a.exr", "--crop", "4,2,16,12", "--seed", 1)
        self.render("b.exr", "--crop", "3,2,16,12", "--seed", 2)
        self.fails(2, "merge", "a.exr", "b.exr", "-o", "c.exr", says=("the window is from (4, 2)", "from (3, 2)"))
        self.render("c.exr", "--crop", "4,2,16,12", "--seed", 2)
        self.succeeds("merge", "a.exr", "c.exr", "-o", "d.exr")
        self.assertEqual(self.windows("d.exr"), ((4, 2, 16, 12), (0, 0, 24, 16)))
        self.succeeds("diff", "a.exr", "d.exr")
        self.render("e.exr", "--crop", "4,2,16,12", "--checkpoint", "e.state")
        self.fails(2, "render", "scene.xml", "-i", "path", "-s", 8, "-o", "e.exr", "--checkpoint", "e.state",
                   "--crop", "3,2,16,12", "--resume", says="crop is 4,2,16,12 there and 3,2,16,12 here")


if __name__ == "__main__":
    _h2mc.main()
