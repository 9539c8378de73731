#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the binary files of the corpus, and the files that its scenes refer to. The scenes and texts beside them are
written by hand. What a fuzzer has found lies in the corpus too, under names that say what it was."""

import json
import os
import struct
import sys
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "scenes"))
import exr  # noqa: E402

# A pyramid without its ground.
POINTS = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1)]
FACES = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]


def save(name, data):
    path = os.path.join(HERE, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as out:
        out.write(data)


def ply(form):
    little = form != "binary_big_endian"
    header = (f"ply\nformat {form} 1.0\ncomment a pyramid\nelement vertex {len(POINTS)}\n"
              "property float x\nproperty float y\nproperty double z\nproperty uchar red\n"
              f"element face {len(FACES)}\nproperty list uchar int vertex_indices\nend_header\n").encode()
    if form == "ascii":
        lines = [f"{x} {y} {z} 7" for x, y, z in POINTS] + [f"3 {a} {b} {c}" for a, b, c in FACES]
        return header + ("\n".join(lines) + "\n").encode()
    order = "<" if little else ">"
    return (header + b"".join(struct.pack(order + "ffdB", *p, 7) for p in POINTS)
            + b"".join(struct.pack(order + "B3i", 3, *f) for f in FACES))


def serialized(version, double, meshes):
    number = "d" if double else "f"
    flags = 0x0001 | 0x0002 | 0x0008 | (0x2000 if double else 0x1000)
    content = struct.pack("<I", flags) + (b"pyramid\0" if version == 4 else b"")
    content += struct.pack("<QQ", len(POINTS), len(FACES))
    for width, row in ((3, (0, 0, 1)), (2, (0.5, 0.25)), (3, (1, 0, 0))):
        if width == 3 and row[2]:
            content += b"".join(struct.pack(f"<3{number}", *p) for p in POINTS)
        content += struct.pack(f"<{width}{number}", *row) * len(POINTS)
    content += b"".join(struct.pack("<3I", *f) for f in FACES)
    data, table = b"", b""
    for _ in range(meshes):
        table += struct.pack("<Q" if version == 4 else "<I", len(data))
        data += struct.pack("<HH", 0x041C, version) + zlib.compress(content, 9)
    return data + table + struct.pack("<I", meshes)


def png(width, height, depth, kind, rows, *chunks):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, 0))
            + b"".join(chunk(*c) for c in chunks) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def hdr(width, height, runs):
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    if not runs:
        return header + bytes((128, 64, 32, 129)) * (width * height)
    line = bytes((2, 2, width >> 8, width & 255))
    line += b"".join(bytes((128 + width, value)) for value in (128, 64, 32, 129))
    return header + line * height


def write_exr(name, compress):
    os.makedirs(os.path.dirname(os.path.join(HERE, name)), exist_ok=True)
    ramp = [0.1 * i for i in range(8)]
    exr.write(os.path.join(HERE, name), 4, 2, [ramp, ramp[::-1], [0.5] * 8], compress=compress)


def half_exr():
    """Grey, 16-bit floats, in tiles."""
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    window = struct.pack("<4i", 0, 0, 3, 3)
    header = (b"\x76\x2f\x31\x01" + struct.pack("<i", 0x202)
              + attribute(b"channels", b"chlist", b"Y\0" + struct.pack("<iB3xii", 1, 0, 1, 1) + b"\0")
              + attribute(b"compression", b"compression", b"\0")
              + attribute(b"dataWindow", b"box2i", window) + attribute(b"displayWindow", b"box2i", window)
              + attribute(b"lineOrder", b"lineOrder", b"\0")
              + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
              + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
              + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))
              + attribute(b"tiles", b"tiledesc", struct.pack("<IIB", 4, 4, 0)) + b"\0")
    pixels = struct.pack("<16e", *[0.125 * i for i in range(16)])
    return (header + struct.pack("<Q", len(header) + 8)
            + struct.pack("<5i", 0, 0, 0, 0, len(pixels)) + pixels)


def checkpoint():
    """With the identity and a state as checkpoint.cpp has them."""
    def text(value):
        return struct.pack("<Q", len(value)) + value
    identity = {"program version": "0", "files": {"scene.xml": "12345678"}, "width": 16, "height": 12,
                "integrator": "h2mc", "options": {"maxDepth": "4"}, "seed": 7}
    data = (text(b"h2mc checkpoint 1\n") + text(json.dumps(identity).encode()) + struct.pack("<Q2d", 2, 0.5, 2)
            + struct.pack("<Q", 2) + text(b"a") + text(b"") + struct.pack("<Q3f", 3, 1, 2, 3)
            + struct.pack("<Bq", 1, 9) + struct.pack("<3i", 1, 2, 3))
    return data + struct.pack("<I", zlib.crc32(data))


OBJ = """# a pyramid
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
v 0 0 1
vt 0 0
vt 1 1
vn 0 0 1
usemtl a
f 1/1/1 2/2/1 5/1/1
f 2//1 3//1 5//1
usemtl b
f -3 -2 -1
f 1 2 3 4
"""


def main():
    save("corpus/obj/pyramid.obj", OBJ.encode())
    save("corpus/obj/triangle.obj", b"v 0 0 0\r\nv 1 0 0\r\nv 0 1e-3 0\r\nf 1 2 3\r\n")
    for form in ("ascii", "binary_little_endian", "binary_big_endian"):
        save(f"corpus/ply/{form}.ply", ply(form))
    save("corpus/serialized/two.serialized", serialized(4, False, 2))
    save("corpus/serialized/double.serialized", serialized(3, True, 1))
    write_exr("corpus/image/plain.exr", False)
    write_exr("corpus/image/zip.exr", True)
    save("corpus/image/half_tiles.exr", half_exr())
    save("corpus/image/flat.hdr", hdr(4, 2, False))
    save("corpus/image/runs.hdr", hdr(8, 3, True))
    rgb = b"".join(b"\0" + bytes(range(y, y + 9)) for y in (0, 90, 200))
    save("corpus/image/rgb.png", png(3, 3, 8, 2, rgb, (b"gAMA", struct.pack(">I", 100000))))
    save("corpus/image/grey16.png", png(2, 2, 16, 0, b"\0\0\1\0\2\1\1\0\2\0"))
    save("corpus/image/palette.png", png(4, 2, 2, 3, b"\0\x1b\0\xe4", (b"PLTE", bytes(range(12))),
                                         (b"tRNS", b"\0\x80\xff")))
    save("corpus/checkpoint/whole.checkpoint", checkpoint())
    save("files/mesh.obj", OBJ.encode())
    save("files/mesh.ply", ply("binary_little_endian"))
    save("files/mesh.serialized", serialized(4, False, 2))
    save("files/picture.png", png(3, 3, 8, 2, rgb))
    save("files/sky.hdr", hdr(8, 4, True))
    write_exr("files/sky.exr", False)


if __name__ == "__main__":
    main()
