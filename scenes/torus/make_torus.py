#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the meshes and sky.hdr, a clear sky with a sun, beside this file."""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from geometry import Mesh, dot, mix, ring, rounded_box, smoothstep, unit  # noqa: E402

WIDTH, HEIGHT = 256, 128
SUN = unit((-0.62, 0.8, 0.5))
SUN_RADIUS = math.radians(2.0)


def sky(direction):
    """Bluer upwards, brighter and warmer towards the sun, brown ground."""
    up = direction[1]
    near = max(dot(direction, SUN), 0.0)
    haze = math.exp(-5 * max(up, 0.0))
    glow = 0.9 * near ** 12 + 0.35 * near ** 3
    blue = [mix(a, b, haze) + glow * c for a, b, c in
            zip((0.13, 0.28, 0.62), (0.62, 0.68, 0.74), (1.0, 0.88, 0.68))]
    ground = (0.16, 0.13, 0.1)
    return [mix(g, s, smoothstep(-0.04, 0.02, up)) for g, s in zip(ground, blue)]


def rgbe(color):
    """Radiance's four bytes: a common exponent."""
    largest = max(color)
    if largest < 1e-32:
        return b"\0\0\0\0"
    exponent = math.frexp(largest)[1]
    return bytes(min(int(math.ldexp(c, 8 - exponent)), 255) for c in color) + bytes([exponent + 128])


def write_sky(path):
    with open(path, "wb") as out:
        out.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode("ascii"))
        for y in range(HEIGHT):
            for x in range(WIDTH):
                total = [0.0, 0.0, 0.0]
                inside = 0
                for k in range(64):                        # 8 x 8 points of the pixel
                    theta = math.pi * (y + (k // 8 + 0.5) / 8) / HEIGHT
                    phi = 2 * math.pi * (x + (k % 8 + 0.5) / 8) / WIDTH
                    d = (math.sin(phi) * math.sin(theta), math.cos(theta), -math.cos(phi) * math.sin(theta))
                    if dot(d, SUN) > math.cos(SUN_RADIUS):
                        inside += 1
                    elif k == 27 or k == 36:
                        total = [t + 0.5 * s for t, s in zip(total, sky(d))]
                share = inside / 64
                out.write(rgbe([t + share * s for t, s in zip(total, (1500.0, 1300.0, 1000.0))]))


def backdrop():
    """A floor that bends up behind."""
    radius, back = 3.0, -3.5
    line = [(4.5, 0.0), (back, 0.0)]
    line += [(back - radius * math.sin(a),
              radius * (1 - math.cos(a))) for a in (math.pi / 2 * k / 24 for k in range(1, 25))]
    line.append((back - radius, 5.0))
    rows = [[(-9.0, y, z), (9.0, y, z)] for z, y in line]
    normals = []
    for k in range(len(line)):
        a = min(max(k - 1, 0) / 24, 1.0) * math.pi / 2
        normals.append([(0.0, math.cos(a), math.sin(a))] * 2)
    return Mesh().grid(rows, normals)


def main():
    write_sky(os.path.join(os.path.dirname(os.path.abspath(__file__)), "sky.hdr"))
    ring(0.56, 0.23, 96, 48).write(__file__, "torus.ply")
    rounded_box((2, 2, 2), 0.04, 6).write(__file__, "cube.ply")
    backdrop().write(__file__, "backdrop.ply")


if __name__ == "__main__":
    main()
