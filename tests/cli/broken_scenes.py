#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A mistake in a scene: exit code 2, one message that shows the place, no image, never a crash."""

import os
import random
import subprocess
import unittest

import _h2mc

GOOD = _h2mc.SCENE
# In files of version 0.x these are warnings.
LEFTOVERS = {"misspelt parameter", "motion"}

# What is replaced in the good scene, by what, and what the message says.
MISTAKES = {
    "unknown plugin": ('type="sphere"', 'type="spere"', ['unknown shape "spere"', "sphere"]),
    "misspelt parameter": ('name="radius"', 'name="raduis"', ['"raduis"', 'did you mean "radius"']),
    "wrong type": ('<float name="radius"', '<string name="radius"', ["not a <string>"]),
    "bad number": ('name="radius" value="0.5"', 'name="radius" value="O.5"', ["is not a number"]),
    "NaN": ('name="radius" value="0.5"', 'name="radius" value="nan"', ["not a finite number"]),
    "far shape": ('name="radius" value="0.5"', 'name="radius" value="1e30"',
                  ["reaches to a coordinate of", "1e+15"]),
    "far camera": ('origin="0, 1, 5"', 'origin="0, 1, 1e19"', ["the camera reaches to a coordinate of 1e+19"]),
    "missing id": ('<ref id="grey"/>', '<ref id="gray"/>', ['"gray"', 'did you mean "grey"']),
    "missing file": ('<bsdf type="diffuse" id="grey">',
                     '<shape type="obj"><string name="filename" value="no.obj"/></shape>'
                     '<bsdf type="diffuse" id="grey">', ['no such file: "no.obj"']),
    "no light": ("<emitter", "<!-- <emitter", ["malformed XML"]),
    "undefined name": ("$radiance, ", "$radianz, ", ['"$radianz"', 'did you mean "radiance"']),
    "second camera": ("</scene>", '<sensor type="perspective"/></scene>', ["a second camera"]),
    "black light": ("$radiance, $radiance, $radiance", "0", ["no light"]),
    "cut short": ("</scene>", "", ["malformed XML"]),
    "motion": ('<rotate x="1" angle="-90"/><scale value="2"/></transform>',
               '<rotate x="1" angle="-90"/></transform><animation name="toWorld"/>',
               ["given twice"]),
}


class BrokenScenes(_h2mc.Test):
    def check(self, name, text, says, *arguments):
        with open(self.path("scene.xml"), "wb") as out:
            out.write(text if isinstance(text, bytes) else text.encode())
        result = self.fails(2, "render", "scene.xml", "-o", "out.exr", *arguments, says=says)
        message = result.stderr.strip()
        self.assertEqual(message.count("error:"), 1, f"{name}: {message}")
        return message

    def test_mistakes(self):
        for name, (old, new, says) in MISTAKES.items():
            with self.subTest(name):
                self.assertIn(old, GOOD)
                text = GOOD.replace(old, new, 1)
                if name in LEFTOVERS:
                    text = text.replace("0.6.0", "3.0.0")
                message = self.check(name, text, says)
                self.assertRegex(message, r"scene\.xml:\d+:\d+: error: ")
                self.assertRegex(message, r"(?m)^ *\^$")

    def test_no_camera(self):
        start, end = GOOD.index("<sensor"), GOOD.index("</sensor>") + len("</sensor>")
        text = GOOD[:start] + GOOD[end:]
        text = text.replace('<default name="width" value="24"/>', "")
        self.check("no camera", text, ["the scene has no camera", "<sensor"])

    def test_unused_define(self):
        self.check("define", GOOD, ["$widht", 'did you mean "width"'], "-D", "widht=3")

    def test_no_such_scene(self):
        self.fails(2, "render", "nothing.xml", "-o", "out.exr", says="nothing.xml")
        self.fails(2, "info", ".", says="folder")

    def test_broken_meshes(self):
        meshes = {
            "m.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "m.obj:4: vertex 4 is out of range"),
            "m.ply": (b"ply\nformat ascii 1.0\nelement vertex 9\n", "m.ply: the header has no end"),
            "m.serialized": (b"\x1c\x04\x04\x00" + bytes(60), "table at the file's end is damaged"),
        }
        for name, (content, says) in meshes.items():
            with open(self.path(name), "wb") as out:
                out.write(content)
            shape = (f'<shape type="{name[2:]}"><string name="filename" value="{name}"/></shape>'
                     "</scene>")
            self.check(name, GOOD.replace("</scene>", shape), ["broken mesh", says])

    def test_garbage(self):
        self.check("empty", b"", "empty")
        self.check("binary", bytes(range(256)), "not a text file")
        self.check("png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "not a text file")
        self.check("text", b"<<<>>>", "malformed XML")

    def test_random_damage_never_crashes(self):
        """Bytes replaced, dropped or doubled: read, or refused with code 2."""
        generator = random.Random(1)
        for _ in range(30):
            text = bytearray(GOOD.encode())
            for _ in range(generator.randint(1, 4)):
                at = generator.randrange(len(text))
                kind = generator.randrange(3)
                if kind == 0:
                    text[at] = generator.randrange(32, 127)
                elif kind == 1:
                    del text[at:at + generator.randint(1, 30)]
                else:
                    text[at:at] = text[at:at + generator.randint(1, 60)]
            with open(self.path("scene.xml"), "wb") as out:
                out.write(text)
            result = subprocess.run([_h2mc.BINARY, "info", "scene.xml"], cwd=self.folder,
                                    stdin=subprocess.DEVNULL, capture_output=True, timeout=60,
                                    check=False)
            self.assertIn(result.returncode, (0, 2), f"{bytes(text)!r}\n{result.stderr!r}")
            if result.returncode == 2:
                self.assertIn(b"error:", result.stderr, bytes(text))

    def test_good_scene_is_read(self):
        self.write("scene.xml", GOOD)
        self.succeeds("info", "scene.xml")


if __name__ == "__main__":
    _h2mc.main()
