#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the pool, its water and what is about it beside this file: metres, the water at y = 0."""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from geometry import Mesh, curve, plane, ring, rounded_box, tiles, tube, unit  # noqa: E402

LEFT, RIGHT, BACK, FRONT, DEPTH, RIM = -2.0, 2.0, -3.0, 2.4, 1.4, 0.16

# Direction in degrees, length, height and phase of the waves.
WAVES = [(20, 1.45, 0.0105, 0.3), (75, 1.05, 0.008, 1.9), (130, 0.8, 0.0058, 4.1), (-25, 0.62, 0.0042, 2.2),
         (165, 0.5, 0.0027, 5.2), (50, 0.41, 0.0019, 0.8), (100, 0.35, 0.0014, 3.3)]


def water():
    columns, lines = 72, 96
    rows, normals = [], []
    for j in range(lines + 1):
        row, row_normals = [], []
        for i in range(columns + 1):
            x = LEFT + (RIGHT - LEFT) * i / columns
            z = FRONT + (BACK - FRONT) * j / lines
            y = dx = dz = 0.0
            for angle, length, height, phase in WAVES:
                k = 2 * math.pi / length
                kx, kz = k * math.cos(math.radians(angle)), k * math.sin(math.radians(angle))
                p = kx * x + kz * z + phase
                y += height * math.sin(p)
                dx += height * kx * math.cos(p)
                dz += height * kz * math.cos(p)
            row.append((x, y, z))
            row_normals.append(unit((-dx, 1.0, -dz)))
        rows.append(row)
        normals.append(row_normals)
    return Mesh().grid(rows, normals)


def basin():
    light, dark, grout = Mesh(), Mesh(), Mesh()
    size, high, shape = 0.2, 7, (0.012, 0.01, 0.006, 1.0)
    wide, deep = round((RIGHT - LEFT) / size), round((FRONT - BACK) / size)

    def line(i, j):
        """Two dark lines along the bottom."""
        return i in (5, 14) and 2 <= j < deep - 2 or j in (2, deep - 3) and i in (4, 6, 13, 15)
    for mesh, wanted in ((light, False), (dark, True)):
        mesh.merge(tiles((LEFT, -DEPTH, FRONT), (1, 0, 0), (0, 0, -1), wide, deep, (size, size), *shape,
                         lambda i, j: line(i, j) == wanted))
        for corner, right, columns in (((LEFT, -DEPTH, BACK), (1, 0, 0), wide),
                                       ((LEFT, -DEPTH, FRONT), (0, 0, -1), deep),
                                       ((RIGHT, -DEPTH, BACK), (0, 0, 1), deep),
                                       ((RIGHT, -DEPTH, FRONT), (-1, 0, 0), wide)):
            mesh.merge(tiles(corner, right, (0, 1, 0), columns, high, (size, size), *shape,
                             lambda i, j: (j == high - 1) == wanted))
    x, z, y = RIGHT - LEFT, FRONT - BACK, DEPTH + RIM - 0.01
    grout.merge(plane((LEFT, -DEPTH, FRONT), (x, 0, 0), (0, 0, -z)))
    grout.merge(plane((LEFT, -DEPTH, BACK), (x, 0, 0), (0, y, 0)))
    grout.merge(plane((LEFT, -DEPTH, FRONT), (0, 0, -z), (0, y, 0)))
    grout.merge(plane((RIGHT, -DEPTH, BACK), (0, 0, z), (0, y, 0)))
    grout.merge(plane((RIGHT, -DEPTH, FRONT), (-x, 0, 0), (0, y, 0)))
    light.write(__file__, "tiles.ply")
    dark.write(__file__, "tiles_dark.ply")
    grout.write(__file__, "grout.ply")

    # Slabs around it; those at the water have a nose.
    deck = Mesh()
    slab = 0.6
    for i in range(-3, 10):
        for j in range(-4, 12):
            x0, z0 = LEFT + slab * i, BACK + slab * j
            x1, z1 = x0 + slab, z0 + slab
            if x0 > LEFT - 0.01 and x1 < RIGHT + 0.01 and z0 > BACK - 0.01 and z1 < FRONT + 0.01:
                continue
            if x0 < RIGHT < x1 and BACK <= z0 < FRONT:
                x0 = RIGHT
            x0, x1 = (x0, x1 + 0.04) if abs(x1 - LEFT) < 0.01 else (x0 - 0.04 if abs(x0 - RIGHT) < 0.01 else x0, x1)
            box = rounded_box((x1 - x0 - 0.008, 0.07, slab - 0.008), 0.012, 1)
            deck.merge(box.moved(((x0 + x1) / 2, RIM - 0.035, (z0 + z1) / 2)))
    deck.write(__file__, "deck.ply")


def things():
    ladder = Mesh()
    for x in (-1.25, -0.75):
        rail = [(x, RIM, BACK - 0.4), (x, 0.62, BACK - 0.38), (x, 0.86, BACK - 0.22), (x, 0.86, BACK - 0.02),
                (x, 0.6, BACK + 0.14),
                (x, 0.1, BACK + 0.16), (x, -0.5, BACK + 0.16), (x, -1.05, BACK + 0.16), (x, -1.12, BACK + 0.04)]
        ladder.merge(tube(curve(rail, 8), 0.021, 16))
    for y in (-0.25, -0.55, -0.85):
        ladder.merge(rounded_box((0.5, 0.025, 0.09), 0.01, 3).moved((-1.0, y, BACK + 0.16)))
    ladder.write(__file__, "ladder.ply")

    float_ring = ring(0.34, 0.115, 60, 24)
    white, red = Mesh(), Mesh()
    for mesh, wanted in ((white, 0), (red, 1)):
        mesh.vertices = float_ring.vertices
        mesh.faces = [f for k, f in enumerate(float_ring.faces) if k // 24 // 6 % 2 == wanted]
    white.write(__file__, "float_white.ply")
    red.write(__file__, "float_red.ply")
    # A ball of six gores.
    for name, wanted in (("ball_white", 0), ("ball_blue", 1)):
        rows = []
        for i in range(25):
            a = math.pi * (i / 24 - 0.5)
            out, up = (math.cos(a), math.sin(a)) if 0 < i < 24 else (0.0, math.copysign(1, a))
            rows.append([(out * math.cos(b), up, -out * math.sin(b))
                         for b in (2 * math.pi * k / 48 for k in range(48))])
        Mesh().grid(rows, rows, wrap_columns=True, keep=lambda i, j, w=wanted: j // 8 % 2 == w).write(__file__,
                                                                                                      name + ".ply")


def main():
    water().write(__file__, "water.ply")
    basin()
    things()


if __name__ == "__main__":
    main()
