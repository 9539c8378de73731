#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc convert, and render's --exposure and --tonemap: values as a screen shows them."""

import math
import os
import struct
import subprocess
import sys
import zlib

import _h2mc

sys.path.insert(0, os.path.join(_h2mc.SOURCE_DIR, "scenes"))
import exr  # noqa: E402  (what the scenes' scripts share)

VALUES = [0.0, 0.001, 0.02, 0.18, 0.5, 1.0, 3.0, 40.0]


def srgb(v):
    v = min(max(v, 0), 1)
    return 255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055)


def filmic(x):
    """Narkowicz's fit of the ACES curve."""
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)


class Convert(_h2mc.Test):
    def setUp(self):
        super().setUp()
        # Grey ramp, and a second row of a colour.
        width = len(VALUES)
        planes = [VALUES + [0.3] * width, VALUES + [0.6] * width, VALUES + [0.9] * width]
        exr.write(self.path("a.exr"), width, 2, planes)

    def png(self, name):
        """(width, height, rows of (r, g, b)) of an 8-bit PNG."""
        with open(self.path(name), "rb") as stream:
            data = stream.read()
        at, pixels = 8, b""
        while at < len(data):
            size, kind = struct.unpack_from(">I4s", data, at)
            if kind == b"IHDR":
                width, height, bits, colour = struct.unpack_from(">IIBB", data, at + 8)
            elif kind == b"IDAT":
                pixels += data[at + 8:at + 8 + size]
            at += 12 + size
        self.assertEqual((bits, colour), (8, 2))
        raw, stride, rows = zlib.decompress(pixels), 3 * width, []
        previous = bytes(stride)
        for y in range(height):
            how, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
            for i in range(stride):
                a, b, c = (row[i - 3] if i >= 3 else 0), previous[i], (previous[i - 3] if i >= 3 else 0)
                p = a + b - c
                paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
                row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[how]) & 255
            previous = bytes(row)
            rows.append([tuple(row[3 * x:3 * x + 3]) for x in range(width)])
        return width, height, rows

    def check(self, name, curve):
        width, height, rows = self.png(name)
        self.assertEqual((width, height), (len(VALUES), 2))
        for value, pixel in zip(VALUES, rows[0], strict=True):
            for channel in pixel:
                self.assertAlmostEqual(channel, srgb(curve(value)), delta=0.51)
        for value, channel in zip((0.3, 0.6, 0.9), rows[1][0]):
            self.assertAlmostEqual(channel, srgb(curve(value)), delta=0.51)

    def test_curves_and_exposure(self):
        for options, curve in (((), lambda v: v), (("--tonemap", "srgb"), lambda v: v),
                               (("--exposure", -2), lambda v: v / 4), (("--exposure", "+1.5"), lambda v: v * 2 ** 1.5),
                               (("--tonemap", "filmic"), filmic),
                               (("--exposure", 1, "--tonemap", "filmic"), lambda v: filmic(2 * v))):
            self.succeeds("convert", "a.exr", "a.png", *options)
            self.check("a.png", curve)

    # The geometric mean of what is lit becomes middle grey.
    def test_automatic_exposure(self):
        luminances = [v for v in VALUES if v > 0]
        luminances += [0.212671 * 0.3 + 0.715160 * 0.6 + 0.072169 * 0.9] * len(VALUES)
        factor = 0.18 / math.exp(sum(map(math.log, luminances)) / len(luminances))
        self.succeeds("convert", "a.exr", "a.png", "--exposure", "auto")
        self.check("a.png", lambda v: factor * v)
        exr.write(self.path("dark.exr"), 2, 1, [[0.0, 0.0]] * 3)
        self.succeeds("convert", "dark.exr", "dark.png", "--exposure", "auto")
        self.assertEqual(self.png("dark.png")[2], [[(0, 0, 0)] * 2])

    def test_formats(self):
        self.succeeds("convert", "a.exr", "b.hdr")
        self.succeeds("convert", "b.hdr", "c.exr", "--exposure", 1)
        for old, new in zip(exr.read(self.path("a.exr"))[3], exr.read(self.path("c.exr"))[3], strict=True):
            for a, b in zip(old, new, strict=True):
                self.assertAlmostEqual(2 * a, b, delta=0.02 * b + 1e-6)
        self.succeeds("convert", "a.exr", "d.exr")
        self.assertEqual(exr.read(self.path("a.exr"))[3], exr.read(self.path("d.exr"))[3])
        self.write_png("e.png", 2, 1, lambda x, y: (x * 100, 20, 30))
        self.succeeds("convert", "e.png", "f.png")
        self.assertEqual(self.png("f.png")[2], [[(0, 20, 30), (100, 20, 30)]])
        self.fails(2, "convert", "a.exr", "g.hdr", "--tonemap", "filmic", says=("filmic", ".png"))

    def test_layers(self):
        self.write("scene.xml", _h2mc.SCENE)
        self.succeeds("render", "scene.xml", "-i", "path", "-s", 1, "-o", "l.exr", "--aov", "albedo,depth,normal",
                      "--crop", "2,3,20,12", "-q")
        planes = exr.read_planes(self.path("l.exr"))[3]
        self.succeeds("convert", "l.exr", "albedo.exr", "--layer", "albedo")
        attributes, width, height, found = exr.read(self.path("albedo.exr"))
        self.assertEqual((width, height), (20, 12))
        self.assertEqual(struct.unpack("<4i", attributes["dataWindow"]), (2, 3, 21, 14))
        self.assertEqual(found, [planes[f"albedo.{channel}"] for channel in "RGB"])
        self.succeeds("convert", "l.exr", "normal.exr", "--layer", "normal")
        self.assertEqual(exr.read(self.path("normal.exr"))[3], [planes[f"normal.{channel}"] for channel in "XYZ"])
        self.succeeds("convert", "l.exr", "depth.exr", "--layer", "depth")
        self.assertEqual(exr.read(self.path("depth.exr"))[3], [planes["depth.Z"]] * 3)
        self.succeeds("convert", "l.exr", "albedo.png", "--layer", "albedo")
        pixel = self.png("albedo.png")[2][6][10]
        self.assertAlmostEqual(pixel[0], srgb(planes["albedo.R"][6 * 20 + 10]), delta=0.51)
        self.fails(2, "convert", "l.exr", "x.png", "--layer", "albdo", says=("albdo", 'did you mean "albedo"'))
        self.fails(2, "convert", "albedo.png", "x.png", "--layer", "albedo", says=("albedo.png", "no layer"))

    def test_render(self):
        self.write("scene.xml", _h2mc.SCENE)
        options, look = ("-i", "path", "-s", 4, "-q"), ("--exposure", "auto", "--tonemap", "filmic")
        self.succeeds("render", "scene.xml", *options, "-o", "a.exr", "--png", *look)
        self.succeeds("convert", "a.exr", "b.png", *look)
        self.succeeds("render", "scene.xml", *options, "-o", "c.png", *look)
        self.assertEqual(self.png("a.png"), self.png("b.png"))
        self.assertEqual(self.png("a.png"), self.png("c.png"))
        # The EXR is what it was.
        self.succeeds("render", "scene.xml", *options, "-o", "d.exr", "--png")
        self.assertEqual(self.picture("a.exr"), self.picture("d.exr"))
        self.assertNotEqual(self.png("a.png"), self.png("d.png"))
        self.fails(2, "render", "scene.xml", *options, "-o", "e.exr", "--exposure", 1, says="--png")

    def test_mistakes(self):
        self.fails(2, "convert", "missing.exr", "x.png", says="missing.exr")
        self.fails(2, "convert", "a.exr", says="OUT")
        self.fails(2, "convert", "a.exr", "x.jpeg", says="x.jpeg")
        self.fails(2, "convert", "a.exr", "./a.exr", says="are one file")
        self.fails(2, "convert", "a.exr", "nowhere/x.png", says="nowhere")
        for bad in ("", "x", "nan", "inf", "101", "1x"):
            self.fails(2, "convert", "a.exr", "x.png", f"--exposure={bad}", says="--exposure")
        self.fails(2, "convert", "a.exr", "x.png", "--tonemap", "aces", says=("--tonemap", "filmic"))
        self.write("text.exr", "no picture")
        self.fails(2, "convert", "text.exr", "x.png", says="text.exr")

    def test_full_disk(self):
        exr.write(self.path("large.exr"), 64, 64, [[i * i % 977 / 977 for i in range(4096)]] * 3)
        for name in ("x.exr", "x.png"):
            self.write(name, "old")
            result = subprocess.run(["bash", "-c", 'ulimit -f 1; trap "" XFSZ; exec "$0" convert large.exr "$1"',
                                     _h2mc.BINARY, name], cwd=self.folder, capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 3, result.stderr)
            with open(self.path(name), encoding="utf-8") as old:
                self.assertEqual(old.read(), "old")


if __name__ == "__main__":
    _h2mc.main()
