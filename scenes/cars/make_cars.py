#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the parts of a car beside this file: metres, driving towards +x, standing on y = 0."""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from geometry import Mesh, block, curve, dish, revolve, ring, spline, tube  # noqa: E402

LENGTH = 2.15       # half of it
WIDTH = 0.84        # half of it
WHEEL = 0.31
AXLES = (-1.30, 1.32)
TOP = [(-2.15, 0.66), (-1.95, 0.86), (-1.40, 0.93), (0.50, 0.92), (1.20, 0.84), (1.85, 0.72), (2.15, 0.58)]
BOTTOM = [(-2.15, 0.36), (-1.8, 0.2), (1.8, 0.18), (2.15, 0.30)]
ROOF = [(-1.80, 0.86), (-1.40, 1.08), (-0.95, 1.32), (-0.50, 1.41), (-0.05, 1.405), (0.30, 1.30), (1.02, 0.84)]


def power(x, p):
    return math.copysign(abs(x) ** p, x)


def body():
    rows = []
    for k in range(65):
        t = -1 + 2 * k / 64
        x = LENGTH * math.sin(t * math.pi / 2) * 0.5 + LENGTH * t * 0.5
        taper = max(1 - abs(x / LENGTH) ** 7, 0) ** (1 / 3.5)
        top, bottom = spline(TOP, x), spline(BOTTOM, x)
        middle, half = (top + bottom) / 2, (top - bottom) / 2 * max(taper, 0.0)
        width = WIDTH * (0.93 + 0.07 * math.cos(x)) * taper
        rows.append([(x, middle + half * power(math.sin(a), 0.55), width * power(math.cos(a), 0.5))
                     for a in (2 * math.pi * i / 48 for i in range(48))])
    return rows


ROWS, COLUMNS = 72, 60


def cabin_row(x):
    roof, foot = spline(ROOF, x), 0.78
    row = []
    for i in range(COLUMNS + 1):
        a = math.pi * i / COLUMNS
        up = power(math.sin(a), 0.62)
        row.append((x, foot + (roof - foot) * up, (0.775 - 0.33 * (roof - foot) * up) * power(math.cos(a), 0.42)))
    return row


def cabin(mesh, glass):
    def is_glass(i, j):
        x = ROOF[0][0] + (ROOF[-1][0] - ROOF[0][0]) * (i + 0.5) / ROWS
        s = (j + 0.5) / COLUMNS
        s = min(s, 1 - s)
        if s > 0.26:
            return x > 0.22 or x < -0.86
        return 0.05 < s < 0.2 and -1.3 < x < 0.46 and not -0.42 < x < -0.3
    rows = [cabin_row(ROOF[0][0] + (ROOF[-1][0] - ROOF[0][0]) * k / ROWS) for k in range(ROWS + 1)]
    return mesh.grid(rows, flip=True, keep=lambda i, j: is_glass(i, j) == glass)


def side(x):
    """How far the body's side stands out there, half way up."""
    return WIDTH * (0.93 + 0.07 * math.cos(x)) * max(1 - abs(x / LENGTH) ** 7, 0) ** (1 / 3.5)


def blob(x, y, z, sizes):
    """An ellipsoid."""
    profile = [(math.cos(a), math.sin(a)) for a in (math.pi * (k / 12 - 0.5) for k in range(13))]
    profile[0], profile[-1] = (0.0, -1.0), (0.0, 1.0)
    return revolve(profile, 20).moved((x, y, z), (1, 0), sizes)


def main():
    paint = cabin(Mesh().grid(body(), wrap_columns=True, flip=True), False)
    for z in (-1, 1):
        paint.merge(blob(0.52, 0.96, z * 0.87, (0.07, 0.07, 0.1)))     # mirrors
    paint.write(__file__, "paint.ply")
    cabin(Mesh(), True).write(__file__, "glass.ply")

    dark, chrome, rims = Mesh(), Mesh(), Mesh()
    tyre = [(0.2, -0.1), (0.29, -0.1), (0.305, -0.08), (WHEEL, -0.05), (WHEEL, 0.05), (0.305, 0.08), (0.29, 0.1),
            (0.2, 0.1), (0.195, 0.06)]
    for x in AXLES:
        for z in (-1, 1):
            place = {"rotate": (0, 90 * z), "offset": (x, WHEEL, z * (side(x) - 0.07))}
            dark.merge(revolve(tyre, 48).moved(**place))
            dark.merge(revolve([(0.2, 0.02), (0.0, 0.02)], 32).moved(**place))
            arch = [(0.39, -0.1), (0.39, 0.07), (0.375, 0.085), (0.36, 0.07), (0.36, 0.05), (0.0, 0.05)]
            dark.merge(revolve(arch, 48).moved((x, WHEEL + 0.02, z * (side(x) - 0.045)), (0, 90 * z)))
            # Chrome around the arch, above the sill.
            arc = [(x + 0.39 * math.cos(a), WHEEL + 0.02 + 0.39 * math.sin(a), z * (side(x) + 0.035))
                   for a in (math.pi * (k / 24 * 1.1 - 0.05) for k in range(25))]
            chrome.merge(tube(arc, 0.014, 8))
    for z in (-1, 1):
        wheel = ring(0.2, 0.018, 48, 10)
        wheel.merge(blob(0, 0.05, 0, (0.055, 0.025, 0.055)))
        for k in range(5):
            a = 2 * math.pi * k / 5
            for b in (a - 0.12, a + 0.12):
                wheel.merge(tube([(0.03 * math.cos(a), 0.05, 0.03 * math.sin(a)),
                                  (0.2 * math.cos(b), 0.035, 0.2 * math.sin(b))], 0.014, 8))
        rims.merge(wheel.moved((0, 0, z * (side(1.3) - 0.02)), (0, 90 * z)))
    rims.write(__file__, "rims.ply")
    dark.merge(blob(2.05, 0.34, 0, (0.1, 0.07, 0.5)))                  # the grille
    dark.write(__file__, "dark.ply")

    for z in (-1, 1):
        points = [(x, 0.5, z * (side(x) + 0.004)) for x in (-0.9 + 1.82 * k / 24 for k in range(25))]
        chrome.merge(tube(points, 0.016, 8))
        rail = [cabin_row(x)[11 if z > 0 else COLUMNS - 11] for x in (-1.38 + 1.9 * k / 40 for k in range(41))]
        chrome.merge(tube(rail, 0.013, 8))
        for x in (-0.75, 0.2):                                         # door handles
            chrome.merge(blob(x, 0.74, z * (side(x) - 0.005), (0.09, 0.018, 0.03)))
    for x, width in ((2.1, 0.62), (-2.1, 0.66)):                       # bumpers
        bend = [(x + math.copysign(0.06 * math.cos(1.3 * t), x) - math.copysign(0.22 * t ** 4, x), 0.4, width * t)
                for t in (k / 12 - 1 for k in range(25))]
        chrome.merge(tube(bend, 0.035, 12))
    chrome.write(__file__, "chrome.ply")

    for name, x, y, sizes in (("headlamps", 2.0, 0.56, (0.08, 0.06, 0.11)),
                              ("taillamps", -2.06, 0.66, (0.05, 0.05, 0.13))):
        lamps = Mesh()
        for z in (-1, 1):
            lamps.merge(blob(x, y, z * 0.56, sizes))
        lamps.write(__file__, name + ".ply")
    street()


def plate(mesh, x0, x1, y0, y1, z):
    """An upright rectangle that faces +z."""
    mesh.grid([[(x0, y0, z), (x1, y0, z)], [(x0, y1, z), (x1, y1, z)]])


def street():
    markings, house, windows, posts, dishes = (Mesh() for _ in range(5))
    for k in range(-4, 4):
        x = 3 * k - 0.4
        markings.grid([[(x, 0.004, -1.55), (x + 1.6, 0.004, -1.55)], [(x, 0.004, -1.68), (x + 1.6, 0.004, -1.68)]])
    house.merge(block((-12, 12), (-0.1, 0.14), (-9, -5.4), 0.02, 2))                    # the pavement
    house.merge(block((-12, 12), (0, 6.5), (-10, -8.5), 0.02, 2))
    for k in range(-4, 5):
        x = 2.6 * k + 0.3
        house.merge(block((x - 1.35, x - 1.1), (0.1, 6), (-8.6, -8.35), 0.02, 2))       # between shop windows
        if k % 3:                                                      # the others are dark
            plate(windows, x - 0.8, x + 0.8, 0.75, 2.5, -8.48)
        house.merge(block((x - 0.03, x + 0.03), (0.7, 2.55), (-8.49, -8.44), 0.02, 2))
        house.merge(block((x - 0.85, x + 0.85), (1.95, 2.0), (-8.49, -8.44), 0.02, 2))
    house.merge(block((-12, 12), (2.75, 2.95), (-8.6, -8.2), 0.02, 2))
    for x, z in ((-9.5, -5.9), (-2.4, -5.9), (4.2, -5.9), (-5.5, 4.6), (0.4, 5.4), (6.5, 4.6)):
        out = -1 if z > 0 else 1
        arm = [(x, 0, z), (x, 3.2, z), (x, 4.3, z + 0.1 * out), (x, 4.75, z + 0.5 * out), (x, 4.8, z + 1.1 * out)]
        if z < 0:
            posts.merge(tube(curve(arm, 8), 0.05, 12))
        dishes.merge(dish(0.5, 0.1).moved((x, 4.8, z + 1.1 * out)))
    dishes.write(__file__, "dishes.ply")
    markings.write(__file__, "markings.ply")
    house.write(__file__, "house.ply")
    windows.write(__file__, "windows.ply")
    posts.write(__file__, "posts.ply")


if __name__ == "__main__":
    main()
