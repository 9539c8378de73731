#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What is read and is no regular file, or too large: exit code 2 and one message within seconds, by every reader."""

import os
import pathlib
import re
import socket
import subprocess

import _h2mc

BODY = "</scene>"
TEXTURE = ('<shape type="sphere"><bsdf type="diffuse"><texture name="reflectance" type="bitmap">'
           '<string name="filename" value="{}"/></texture></bsdf></shape></scene>')

# What goes before the end of a good scene so that a file is read, by the ending of its name.
IN_SCENE = {
    "include .xml": '<include filename="{}"/></scene>',
    "obj .obj": '<shape type="obj"><string name="filename" value="{}"/></shape></scene>',
    "ply .ply": '<shape type="ply"><string name="filename" value="{}"/></shape></scene>',
    "serialized .serialized": '<shape type="serialized"><string name="filename" value="{}"/></shape></scene>',
    "spectrum .spd": '<emitter type="point"><spectrum name="intensity" filename="{}"/></emitter></scene>',
    "envmap .exr": '<emitter type="envmap"><string name="filename" value="{}"/></emitter></scene>',
    **{f"bitmap {ending}": TEXTURE for ending in (".exr", ".hdr", ".png", ".jpg", ".bmp", ".tga", ".gif")},
}

# What is no file, and how it is called.
KINDS = {"pipe": "a pipe", "device": "a device", "socket": "a socket", "folder": "a folder"}


class Inputs(_h2mc.Test):
    def make(self, kind, name):
        path = self.path(name)
        if kind == "pipe":
            os.mkfifo(path)
        elif kind == "device":
            os.symlink("/dev/zero", path)
        elif kind == "folder":
            os.mkdir(path)
        else:
            # A socket's path is short.
            here = os.getcwd()
            os.chdir(self.folder)
            try:
                with socket.socket(socket.AF_UNIX) as made:
                    made.bind(name)
            finally:
                os.chdir(here)
        return name

    def refused(self, *arguments, says):
        message = self.refuses_at_once(*arguments, says=says, megabytes=1000)
        self.assertEqual(len(re.findall("cannot read|broken mesh|no such file", message)), 1, message)

    def test_every_reader_of_a_scene(self):
        for reader, body in IN_SCENE.items():
            for kind, word in KINDS.items():
                with self.subTest(reader=reader, kind=kind):
                    name = self.make(kind, kind + reader.replace(" ", "-"))
                    self.write("scene.xml", _h2mc.SCENE.replace(BODY, body.format(name)))
                    # A folder is not found where a file is looked for.
                    self.refused("info", "scene.xml", says=[name, "no such file" if kind == "folder" else word])

    def test_what_the_command_line_names(self):
        self.write_png("good.png", 4, 4, lambda x, y: (9, 9, 9))
        self.write("scene.xml", _h2mc.SCENE)
        for kind, word in KINDS.items():
            scene, image = self.make(kind, kind + ".xml"), self.make(kind, kind + ".exr")
            for arguments in (["info", scene], ["render", scene, "-o", "out.exr"], ["gradcheck", scene],
                              ["stress", scene], ["inspect", scene, "--pixel", "1,1", "-o", "out"],
                              ["compare", scene, "-m", "1", "-o", "out"]):
                with self.subTest(arguments):
                    self.refused(*arguments, says=[scene, word])
            for arguments in (["diff", image, "good.png"], ["diff", "good.png", image],
                              ["demo", "image-copy", image, "-o", "out"],
                              ["compare", "scene.xml", "-m", "1", "-i", "path", "--reference", image, "-o", "out"]):
                with self.subTest(arguments):
                    self.refused(*arguments, says=[image, word])

    def test_size(self):
        for reader, body in IN_SCENE.items():
            with self.subTest(reader):
                name = "large" + reader.replace(" ", "-")
                text = reader.split()[0] in ("include", "spectrum")
                with open(self.path(name), "wb") as out:  # of no blocks
                    out.truncate(64_000_001 if text else 16_000_000_001)
                self.write("scene.xml", _h2mc.SCENE.replace(BODY, body.format(name)))
                self.refused("info", "scene.xml", says=[name, "at most 64 MB" if text else "at most 16 GB"])

    def test_text_of_all_includes(self):
        self.write("part.xml", "<scene version='0.6.0'>" + " " * 30_000_000 + "</scene>")
        include = '<include filename="part.xml"/>'
        self.write("scene.xml", _h2mc.SCENE.replace(BODY, 3 * include + BODY))
        self.refused("info", "scene.xml", says=["with it the scene has 90 MB of text", "at most 64 MB"])

    def test_names_made_of_names(self):
        defaults = '<default name="a" value="0123456789"/>'
        for before, name in zip("abcdefghij", "bcdefghijk"):
            defaults += f'<default name="{name}" value="{("$" + before) * 10}"/>'
        self.write("scene.xml", _h2mc.SCENE.replace("<sensor", defaults + "<sensor", 1))
        result = self.fails(2, "info", "scene.xml", says=("too long", "at most 1048576"))
        self.assertLess(len(result.stderr), 10000)

    def test_a_pipe_behind_stdin_is_refused_and_a_file_is_read(self):
        self.write("scene.xml", _h2mc.SCENE)
        with open(self.path("scene.xml"), "rb") as stream:
            result = subprocess.run([_h2mc.BINARY, "info", "/dev/stdin"], stdin=stream, capture_output=True,
                                    timeout=200, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = subprocess.run([_h2mc.BINARY, "info", "/dev/stdin"], input=_h2mc.SCENE.encode(), capture_output=True,
                                timeout=200, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn(b"a pipe", result.stderr)

    def test_no_reader_opens_files_by_itself(self):
        """What is opened elsewhere than in input_file.cpp has not been looked at."""
        allowed = {"render/core/input_file.cpp", "compare/results.cpp", "render/image/atomic_file.cpp",
                   "render/image/image_formats.cpp", "oiio/image_formats.cpp", "render/core/memory.cpp",
                   "cli/checkpoint.h", "cli/checkpoint.cpp", "cli/identity.cpp"}
        source = pathlib.Path(_h2mc.SOURCE_DIR) / "src"
        for file in source.rglob("*"):
            if file.suffix not in (".h", ".cpp") or str(file.relative_to(source)) in allowed:
                continue
            found = re.findall(r"std::i?fstream|\bfopen\(|\bopen\([^;]*\bO_[A-Z]+|filebuf|\bmmap\(",
                               file.read_text(encoding="utf-8"))
            self.assertEqual(found, [], file)


if __name__ == "__main__":
    _h2mc.main()
