#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Headers of images and meshes that promise more than there is: exit code 2 at once, with little memory."""

import struct
import zlib

import _h2mc

MOST_MEGABYTES = 400  # of which OpenImageIO's libraries alone take a third
ZEROS = bytes(700)


def exr(width, height, tile=None, compression=3):
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data
    channels = b"".join(c + b"\0" + struct.pack("<iiii", 1, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    data = b"\x76\x2f\x31\x01" + struct.pack("<I", 2 | (0x200 if tile else 0))
    data += attribute(b"channels", b"chlist", channels)
    data += attribute(b"compression", b"compression", bytes([compression]))
    data += attribute(b"dataWindow", b"box2i", window) + attribute(b"displayWindow", b"box2i", window)
    data += attribute(b"lineOrder", b"lineOrder", b"\0")
    data += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    data += attribute(b"screenWindowCenter", b"v2f", bytes(8))
    data += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))
    if tile:
        data += attribute(b"tiles", b"tiledesc", struct.pack("<IIB", *tile, 0))
    return data + b"\0" + bytes(350)


def png(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(bytes(1000))) + chunk(b"IEND", b""))


def bmp(width, height, bits, compression):
    return (b"BM" + struct.pack("<IHHI", 200, 0, 0, 54 + 1024)
            + struct.pack("<IiiHHIIiiII", 40, width, height, 1, bits, compression, 0, 0, 0, 256, 0) + bytes(1124))


def jpeg(width, height, frame):
    return (b"\xff\xd8\xff\xe0" + struct.pack(">H", 4) + b"ab" + b"\xff" + bytes([frame])
            + struct.pack(">HBHHB", 17, 8, height, width, 3) + bytes([1, 0x11, 0, 2, 0x11, 0, 3, 0x11, 0]) + ZEROS)


def tiff(width, height):
    tags = [(256, 4, width), (257, 4, height), (258, 3, 8), (259, 3, 8), (262, 3, 2), (273, 4, 8), (277, 3, 3),
            (278, 4, height), (279, 4, 100)]
    return (b"II*\0" + struct.pack("<I", 108) + bytes(100) + struct.pack("<H", len(tags))
            + b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in tags) + bytes(4))


def gif(width, height):
    return (b"GIF89a" + struct.pack("<HHBBB", width, height, 0x80, 0, 0) + bytes(6) + b","
            + struct.pack("<HHHHB", 0, 0, width, height, 0) + b"\x02\x02\x4c\x01\x00;")


def webp(kind, data):
    body = b"WEBP" + kind + struct.pack("<I", len(data)) + data
    return b"RIFF" + struct.pack("<I", len(body)) + body


def heif(width, height):
    meta = struct.pack(">I", 20) + b"ispe" + struct.pack(">III", 0, width, height)
    return (struct.pack(">I", 24) + b"ftypavif" + bytes(12) + struct.pack(">I", 708) + b"mdat" + ZEROS
            + struct.pack(">I", 8 + len(meta)) + b"meta" + meta)


HDR = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n"
IMAGES = {
    "scanlines.exr": exr(16384, 16384),
    "tiles.exr": exr(16384, 16384, tile=(16384, 16384)),
    "tile.exr": exr(4, 4, tile=(16384, 16384)),
    "dwa.exr": exr(16384, 16384, compression=9),
    "tall.exr": exr(1, 2**30),
    "wide.hdr": HDR % (1, 10**9) + ZEROS,
    "huge.hdr": HDR % (10**9, 10**9) + ZEROS,
    "wider-than-int.hdr": HDR % (1, 2**31 + 5) + ZEROS,
    "middling.hdr": HDR % (16000, 16000) + ZEROS,
    "huge.png": png(10**6, 10**6),
    "middling.png": png(16384, 16384),
    "huge.pfm": b"PF\n1000000000 1000000000\n-1.0\n" + ZEROS,
    "middling.ppm": b"P6\n16000 16000\n255\n" + ZEROS,
    "raw.bmp": bmp(16000, 16000, 24, 0),
    "rle.bmp": bmp(16000, -16000, 8, 1),
    "raw.tga": struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 65535, 65535, 32, 0) + ZEROS,
    "padded.jpg": b"\xff\xd8" + b"\xff" * 200000 + jpeg(65500, 65500, 0xC2)[2:],
    "baseline.jpg": jpeg(65500, 65500, 0xC0),
    "progressive.jpg": jpeg(16000, 16000, 0xC2),
    "deflated.tif": tiff(16000, 16000),
    "huge.tif": tiff(10**5, 10**5),
    "small-file.gif": gif(16000, 16000),
    "huge.gif": gif(65535, 65535),
    "lossless.webp": webp(b"VP8L", b"\x2f" + struct.pack("<I", 16382 | 16382 << 14) + ZEROS),
    "lossy.webp": webp(b"VP8 ", bytes(3) + b"\x9d\x01\x2a" + struct.pack("<HH", 16383, 16383) + ZEROS),
    "extended.webp": webp(b"VP8X", bytes(4) + b"\xff\xff\xff\xff\xff\x00" + ZEROS),
    "huge.avif": heif(65535, 65535),
}


def serialized(vertices, triangles):
    raw = struct.pack("<I", 0x1000) + b"name\0" + struct.pack("<QQ", vertices, triangles) + bytes(5000)
    return b"\x1c\x04\x04\x00" + zlib.compress(raw) + struct.pack("<QI", 0, 1)


PLY = b"ply\nformat %s 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n" \
      b"element face %d\nproperty list uchar int vertex_indices\nend_header\n"
MESHES = {
    "vertices.ply": PLY % (b"binary_little_endian", 900, 1) + bytes(2000),
    "faces.ply": PLY % (b"ascii", 3, 900) + b"0 " * 700,
    "overflow.ply": PLY % (b"ascii", 2**63 - 1, 1) + b"0 " * 700,
    "vertices.serialized": serialized(4 * 10**9, 1),
    "triangles.serialized": serialized(3, 4 * 10**9),
}
SHAPE = '<shape type="{}"><string name="filename" value="{}"/></shape></scene>'
LAMP = '<emitter type="envmap"><string name="filename" value="{}"/></emitter></scene>'


class Headers(_h2mc.Test):
    def refused(self, *arguments, says):
        self.refuses_at_once(*arguments, says=says, megabytes=MOST_MEGABYTES)

    def test_images(self):
        self.write_png("good.png", 4, 4, lambda x, y: (9, 9, 9))
        for name, data in IMAGES.items():
            with open(self.path(name), "wb") as out:
                out.write(data)
            self.write("scene.xml", _h2mc.SCENE.replace("</scene>", LAMP.format(name)))
            with self.subTest(name):
                self.refused("diff", name, "good.png", says=[name, "its header says"])
                self.refused("info", "scene.xml", says=[name, "its header says"])

    def test_limit(self):
        self.write_png("good.png", 40, 30, lambda x, y: (9, 9, 9))
        self.write("scene.xml", _h2mc.SCENE.replace("</scene>", LAMP.format("good.png")))
        self.succeeds("diff", "good.png", "good.png", "--max-texture-pixels", 1200)
        self.succeeds("info", "scene.xml", "--max-texture-pixels", 1200)
        says = ["good.png", "40 x 30 pixels", "at most 1199", "--max-texture-pixels"]
        limit = ["--max-texture-pixels", 1199]
        self.refused("diff", "good.png", "good.png", *limit, says=says)
        self.refused("demo", "image-copy", "good.png", *limit, says=says)
        for command in ("info", "render", "gradcheck", "stress"):
            self.refused(command, "scene.xml", *limit, says=says)
        self.refused("inspect", "scene.xml", "--pixel", "1,1", *limit, says=says)
        self.refused("compare", "scene.xml", "-m", 1, "-o", "out", *limit, says=says)
        for bad in ("0", "-1", "x", "1e9"):
            self.fails(2, "info", "scene.xml", "--max-texture-pixels", bad, says="expected a whole number")
        for bad in ("0", "-1", "x", "inf"):
            self.fails(2, "info", "scene.xml", "--max-memory", bad, says="expected a number above 0")

    def test_a_large_image_needs_memory(self):
        self.write_png("good.png", 3000, 2000, lambda x, y: (9, 9, 9))
        self.succeeds("diff", "good.png", "good.png", "--metric", "relmse", "--max-memory", 2)
        self.refused("diff", "good.png", "good.png", "--max-memory", 0.05,
                     says=["good.png", "3000 x 2000", "144 MB", "--max-memory"])

    def test_meshes(self):
        for name, data in MESHES.items():
            with open(self.path(name), "wb") as out:
                out.write(data)
            self.write("scene.xml", _h2mc.SCENE.replace("</scene>", SHAPE.format(name.split(".")[1], name)))
            with self.subTest(name):
                self.refused("info", "scene.xml", says=[name, "too short" if name.endswith("ply") else "can't hold"])


if __name__ == "__main__":
    _h2mc.main()
