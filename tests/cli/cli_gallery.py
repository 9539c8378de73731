#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs/gallery: a picture of each scene, within the size that a repository can bear, and what its script reckons."""

import glob
import os
import re
import struct
import sys

import _h2mc

sys.path.insert(0, os.path.join(_h2mc.SOURCE_DIR, "scripts"))
import gallery  # noqa: E402  (the script itself)

FOLDER = os.path.join(_h2mc.SOURCE_DIR, "docs", "gallery")


def jpeg_size(path):
    """(width, height), from the first frame header."""
    with open(path, "rb") as stream:
        data = stream.read()
    assert data[:2] == b"\xff\xd8", path
    at = 2
    while data[at + 1] not in (0xc0, 0xc1, 0xc2):
        at += 2 + struct.unpack_from(">H", data, at + 2)[0]
    height, width = struct.unpack_from(">HH", data, at + 5)
    return width, height


class Gallery(_h2mc.Test):
    def test_every_scene_is_there(self):
        scenes = sorted(os.path.basename(os.path.dirname(xml))
                        for xml in glob.glob(os.path.join(_h2mc.SOURCE_DIR, "scenes", "*", "*.xml")))
        self.assertEqual(sorted(gallery.SCENES), scenes)
        pictures = sorted(name for name in os.listdir(FOLDER) if name.endswith(".jpg"))
        self.assertEqual(pictures, [scene + ".jpg" for scene in scenes])
        for picture in pictures:
            self.assertEqual(jpeg_size(os.path.join(FOLDER, picture))[0], 1024, picture)
        self.assertLess(sum(os.path.getsize(os.path.join(FOLDER, name)) for name in pictures), gallery.MOST_BYTES)

    def test_captions(self):
        with open(os.path.join(FOLDER, "README.md"), encoding="utf-8") as stream:
            page = stream.read()
        commands = re.findall(r"(?m)^    h2mc (render .*)", page)
        errors = re.findall(r"estimated relMSE ([\d.e-]*\d)", page)
        self.assertEqual((len(commands), len(errors)), (len(gallery.SCENES), len(gallery.SCENES)))
        for scene, command, error in zip(gallery.SCENES, commands, errors, strict=True):
            self.assertTrue(command.startswith(" ".join(gallery.command_of(scene))), command)
            self.assertGreater(float(error), 0)
            self.assertIn(f"]({scene}.jpg)", page)

    def test_the_error_is_that_of_diff(self):
        """A picture whose variance is the square of its distance from another has that relMSE."""
        self.write("scene.xml", _h2mc.SCENE)
        for name, seed in (("a", 1), ("b", 2)):
            self.succeeds("render", "scene.xml", "-i", "path", "-s", 4, "--seed", seed, "-q", "-o", name + ".exr")
        a, b = (gallery.exr.read_planes(self.path(name))[3] for name in ("a.exr", "b.exr"))
        planes = dict(b)
        for letter in "RGB":
            planes["variance." + letter] = [(x - y) ** 2 for x, y in zip(a[letter], b[letter], strict=True)]
        said = self.succeeds("diff", "a.exr", "b.exr", "--metric", "relmse").stdout.split()[1]
        # There m is the mean luminance.
        self.assertAlmostEqual(gallery.error_of(planes) / float(said), 1, 3)


if __name__ == "__main__":
    _h2mc.main()
