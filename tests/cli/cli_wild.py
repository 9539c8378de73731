#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Small inputs of the kinds that people have: each of wild/ in the data folder with the value or message that is
expected of it, and further ones of the same kinds, written here."""

import os
import re
import struct
import sys
import unittest
import zlib

import _h2mc

WILD = os.path.join(os.environ.get("H2MC_DATA_DIR", ""), "wild")
SRGB_128 = ((128 / 255 + 0.055) / 1.055) ** 2.4

HEAD = """<scene version="{}">
  <sensor type="perspective"><float name="fov" value="22.619865"/>
    <transform name="toWorld"><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="24"/>
      <rfilter type="box"/></film>
  </sensor>
"""
SKY = '<emitter type="constant"><spectrum name="radiance" value="1"/></emitter>'
GREY = ('<bsdf type="twosided"><bsdf type="diffuse"><spectrum name="reflectance" value="0.5"/></bsdf>'
        '</bsdf>')
SQUARE = '<shape type="rectangle">' + GREY + "</shape>"
MESH = '<shape type="{0}"><string name="filename" value="m.{0}"/>' + GREY + "</shape>"
PICTURE = ('<shape type="rectangle"><bsdf type="twosided"><bsdf type="diffuse">'
           '<texture name="reflectance" type="bitmap"><string name="filename" value="t.png"/>'
           "</texture></bsdf></bsdf></shape>")


def scene(content, version="0.6.0"):
    return HEAD.format(version) + content + "</scene>\n"


class WildTest(_h2mc.Test):
    def write_bytes(self, name, data):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "wb") as out:
            out.write(data)

    def mean_of(self, name):
        """Of each channel of a picture of 32-bit floats, compressed by zlib."""
        header, data = self.read_exr(name)
        self.assertEqual(header["compression"], b"\3")
        left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
        width, height = right - left + 1, bottom - top + 1
        channels = re.findall(rb"([^\0]+)\0(.{16})", header["channels"], re.DOTALL)
        self.assertTrue(all(struct.unpack_from("<i", kind)[0] == 2 for _, kind in channels))
        blocks = (height + 15) // 16
        position, lines = 8 * blocks, b""
        for _ in range(blocks):
            size = struct.unpack_from("<i", data, position + 4)[0]
            packed = data[position + 8:position + 8 + size]
            position += 8 + size
            raw = min(16 * width * 4 * len(channels), 4 * width * len(channels) * height - len(lines))
            lines += packed if size == raw else self.unpacked(packed)
        sums = {channel.decode(): 0.0 for channel, _ in channels}
        for y in range(height):
            for i, channel in enumerate(sums):
                start = 4 * width * (y * len(channels) + i)
                sums[channel] += sum(struct.unpack_from(f"<{width}f", lines, start))
        return [sums[c] / (width * height) for c in "RGB"]

    @staticmethod
    def unpacked(packed):
        """What OpenEXR's zlib compression was given: bytes as differences, those of even places first."""
        total, values = 128, bytearray()
        for byte in zlib.decompress(packed):
            total = (total + byte - 128) & 255
            values.append(total)
        half = (len(values) + 1) // 2
        result = bytearray(len(values))
        result[0::2], result[1::2] = values[:half], values[half:]
        return bytes(result)

    def render(self, file, *arguments):
        """Returns (mean of the channels, what was said)."""
        said = self.succeeds("render", file, "-o", "out.exr", *arguments).stderr
        return self.mean_of("out.exr"), said

    def expect(self, file, mean, *arguments):
        """By path tracing, and by what the scene or the default says."""
        values, said = self.render(file, "-i", "path", "--samples-per-pixel", 256, *arguments)
        for value, expected in zip(values, [mean] * 3 if isinstance(mean, float) else mean):
            self.assertAlmostEqual(value, expected, delta=0.005 * max(expected, 0.1), msg=file)
        return said


@unittest.skipUnless(os.path.isdir(WILD), f"there is no {WILD}: see H2MC_DATA_DIR")
class Wild(WildTest):
    def file(self, name):
        return os.path.join(WILD, name, "scene.xml")

    def test_means(self):
        for name, mean in (("negative-eta", (0.991, 0.878, 0.891)), ("hide-emitters", 0.0691),
                           ("obj-named-bsdfs", (0.25, 0.0, 0.25)), ("obj-continuation", 0.5),
                           ("obj-face-first", 0.5), ("obj-concave", 0.625), ("png-gama1", 0.502),
                           ("xml-utf16", 0.5), ("include-nested", 0.5), ("film-ref", 0.5),
                           ("v3-checkerboard-to-uv", 0.5)):
            with self.subTest(name):
                self.expect(self.file(name), mean, "--width", 48, "--height", 48)

    def test_the_command_line_goes_before_an_unknown_integrator(self):
        file = self.file("integrator-override")
        said = self.render(file, "-i", "path", "--samples-per-pixel", 4)[1]
        self.assertIn('warning: unknown integrator "my_integrator"', said)
        self.assertEqual(self.read_exr("out.exr")[0]["integrator"], "path")
        said = self.render(file, "-m", 2, "-i", ":bootstrapSamples=4000,chains=32")[1]
        self.assertIn('warning: unknown integrator "my_integrator"', said)
        self.assertEqual(self.read_exr("out.exr")[0]["integrator"], "h2mc")

    def test_leftovers_are_warnings_with_their_places(self):
        said = self.render(self.file("unknown-parameter"), "--samples-per-pixel", 4)[1]
        for name, of in (("faceNormals", "shape"), ("alpha", "bsdf")):
            self.assertRegex(said, rf'scene\.xml:\d+:\d+: warning: unknown parameter "{name}" of {of}')

    def test_a_spectrum_may_be_a_bitmap(self):
        said = self.succeeds("info", self.file("spectrum-bitmap")).stdout
        self.assertIn("diffuse", said)
        self.render(self.file("spectrum-bitmap"), "--samples-per-pixel", 4)

    def test_lamps_without_area_are_named(self):
        self.fails(2, "render", self.file("light-only-zero-area"), "-o", "out.exr",
                   says=("the scene has no light", 'left out: shape "obj m.obj" has no area, so its '
                         "emitter emits nothing"))

    def test_a_point_light_in_a_plane(self):
        # Half of its light would be a spot on the floor that path tracing does not find.
        file = self.file("point-in-plane")
        values = {}
        for name in _h2mc.INTEGRATORS:
            budget = ("--samples-per-pixel", 128) if name in _h2mc.SAMPLERS else ("-m", 96)
            integrator = name
            if name in _h2mc.CHAINS:
                integrator += ":bootstrapSamples=30000"
            values[name] = self.render(file, "-i", integrator, "--seed", 3, *budget)[0][0]
        for name, value in values.items():
            self.assertAlmostEqual(value, 0.03057, delta=0.0005, msg=values)


class OfTheSameKinds(WildTest):
    def test_encodings(self):
        text = f'<?xml version="1.0" encoding="{{}}"?>\n{scene(SKY + SQUARE)}<!-- gr\u00fcn -->\n'
        for name, data in (
                ("utf8", b"\xef\xbb\xbf" + text.format("utf-8").encode("utf-8")),
                ("utf16be", b"\xfe\xff" + text.format("utf-16").encode("utf-16-be")),
                ("utf16le", text.format("utf-16").encode("utf-16-le")),
                ("latin1", text.format("ISO-8859-1").encode("latin-1"))):
            with self.subTest(name):
                self.write_bytes("scene.xml", data)
                self.expect("scene.xml", 0.5)

    def test_polygons(self):
        self.write("obj.xml", scene(SKY + MESH.format("obj")))
        self.write("ply.xml", scene(SKY + MESH.format("ply")))
        corners = {
            "arrow": [(0, -0.5), (1, -1), (0, 1), (-1, -1)],
            "L": [(1, 0), (0, 0), (0, 1), (-1, 1), (-1, -1), (1, -1)],
            "comb": [(-1, -1), (1, -1), (1, 1), (0.6, 1), (0.6, -0.6), (0.2, -0.6), (0.2, 1),
                     (-0.2, 1), (-0.2, -0.6), (-0.6, -0.6), (-0.6, 1), (-1, 1)],
            "spiral": [(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -0.6), (0.6, -0.6), (0.6, 0.6),
                       (-0.6, 0.6), (-0.6, -0.2), (0.2, -0.2), (0.2, 0), (-0.4, 0), (-0.4, 0.4),
                       (0.4, 0.4), (0.4, -0.4), (-0.8, -0.4), (-0.8, 0.8), (0.8, 0.8), (0.8, -0.8),
                       (-1, -0.8)]}
        for name, points in corners.items():
            area = sum(x * v - u * y for (x, y), (u, v) in zip(points, points[1:] + points[:1])) / 2
            for turned in (False, True):
                order = points[::-1] if turned else points
                numbers = range(len(order))
                self.write("m.obj", "".join(f"v {x} {y} 0\n" for x, y in order)
                           + "f " + " ".join(str(i + 1) for i in numbers) + "\n")
                self.write("m.ply", "ply\nformat ascii 1.0\nelement face 1\n"
                           "property list uchar int vertex_indices\n"
                           f"element vertex {len(order)}\nproperty float x\nproperty float y\n"
                           f"property float z\nend_header\n{len(order)} "
                           + " ".join(map(str, numbers)) + "\n"
                           + "".join(f"{x} {y} 0\n" for x, y in order))
                for kind in ("obj", "ply"):
                    with self.subTest(name, turned=turned, kind=kind):
                        self.expect(kind + ".xml", 1 - 0.5 * area / 4)

    def test_obj_lines(self):
        self.write("scene.xml", scene(SKY + MESH.format("obj")))
        square = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
        for name, text in (
                ("negative and continued", square + "f -4 -3 \\\r\n -2 -1\r\n"),
                ("continued in a word", square + "f 1 2\\\n3 4\n"),
                ("continued over a line that is one word", square + "f 1 \\\n2 \\\n3 \\\n4\n"),
                ("a comment's end", "# C:\\models\\\n" + square + "f 1 2 3 4\n"),
                ("negative before later vertices",
                 "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf -3 -2 -1\nv -1 1 0\nf -4 -2 -1\n"),
                ("faces before vertices",
                 "f 1//1 2//1 3//1\n" + square + "f 1//1 3//1 4//1\nvn 0 0 1\n")):
            with self.subTest(name):
                self.write("m.obj", text)
                self.expect("scene.xml", 0.5)
        self.write("m.obj", "f 1 2 5\n" + square)
        self.fails(2, "render", "scene.xml", says="m.obj:1: vertex 5 is out of range: there are 4")
        self.write("m.obj", "v 0 0 0\nf -1 -2 -1\nv 1 0 0\nv 0 1 0\n")
        self.fails(2, "render", "scene.xml",
                   says="m.obj:2: vertex -2 is out of range: there are 1 so far")

    def test_png_gamma(self):
        self.write("scene.xml", scene(SKY + PICTURE))
        for gamma, mean in ((45455, SRGB_128), (0, SRGB_128), (55556, (128 / 255) ** 1.8),
                            (100000, 128 / 255)):
            with self.subTest(gamma):
                self.write_png("t.png", 2, 2, lambda x, y: (128,) * 3)
                with open(self.path("t.png"), "rb") as stream:
                    data = stream.read()
                chunk = b"gAMA" + struct.pack(">I", gamma)
                chunk = struct.pack(">I", 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
                header = 8 + 25
                if gamma:
                    self.write_bytes("t.png", data[:header] + chunk + data[header:])
                self.expect("scene.xml", mean)

    def test_includes_by_any_name(self):
        inner = '<scene version="0.6.0">' + SQUARE + "</scene>"
        outer = '<scene version="0.6.0"><include filename="{}"/></scene>'
        for name in ("c/d.xml", self.path("a/c/d.xml"), "a/c/d.xml", "../a/c/d.xml"):
            for first in ("a/b.xml", self.path("a/b.xml")):
                with self.subTest(name, first=first):
                    self.write("scene.xml", scene(SKY + f'<include filename="{first}"/>'))
                    self.write_bytes("a/b.xml", outer.format(name).encode())
                    self.write_bytes("a/c/d.xml", inner.encode())
                    self.expect("scene.xml", 0.5)

    def test_one_lamp_of_several_without_area(self):
        self.write("m.obj", "v -1 -1 0\nv 0 0 0\nv 1 1 0\nf 1 2 3\n")
        lamp = '<shape type="obj"><string name="filename" value="m.obj"/><emitter type="area"/></shape>'
        self.write("scene.xml", scene(lamp + SKY + SQUARE))
        self.assertIn("so its emitter emits nothing", self.expect("scene.xml", 0.5))

    def test_leftovers_by_version(self):
        lamp = '<shape type="rectangle"><emitter type="area"><float name="exponent" value="2"/></emitter></shape>'
        self.write("scene.xml", scene(lamp))
        self.assertIn('warning: unknown parameter "exponent" of emitter',
                      self.expect("scene.xml", 1.0))
        self.write("scene.xml", scene(lamp, "2.1.0"))
        self.fails(2, "render", "scene.xml", says='error: unknown parameter "exponent"')

    def test_parts_that_are_named_elsewhere(self):
        text = scene(SKY + SQUARE + '<sampler type="independent" id="S"/><rfilter type="box" id="R"/>', "3.0.0")
        text = text.replace('<rfilter type="box"/>', '<ref id="R"/>', 1)
        self.write("scene.xml", text.replace("</sensor>", '<ref id="S"/></sensor>'))
        self.expect("scene.xml", 0.5)


if __name__ == "__main__":
    if not os.path.isdir(WILD):
        print(f"skipped: there is no {WILD}: see H2MC_DATA_DIR", file=sys.stderr)
        sys.exit(77)
    _h2mc.main()
