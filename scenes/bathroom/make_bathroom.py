#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the bathroom's parts beside this file: metres, the floor at y = 0."""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from geometry import (Mesh, block, curve, mix, plane, revolve, ring, rounded_box, smooth, smoothstep,  # noqa: E402
                      tiles, tube)

LEFT, RIGHT, BACK, FRONT, TOP = -1.3, 1.3, -1.2, 2.3, 2.45


def walls():
    plain, blue, floor, grout = Mesh(), Mesh(), Mesh(), Mesh()
    size, rows, band = (0.2, 0.1), 20, 12
    for corner, right, length in (((LEFT, 0, BACK), (1, 0, 0), RIGHT - LEFT),
                                  ((LEFT, 0, FRONT), (0, 0, -1), FRONT - BACK),
                                  ((RIGHT, 0, BACK), (0, 0, 1), FRONT - BACK)):
        columns = round(length / size[0])
        for mesh, wanted in ((plain, False), (blue, True)):
            mesh.merge(tiles(corner, right, (0, 1, 0), columns, rows, size, 0.004, 0.008, 0.0035, 1.5,
                             lambda i, j: (j == band) == wanted))
    floor.merge(tiles((LEFT, 0, FRONT), (1, 0, 0), (0, 0, -1), 9, 12, ((RIGHT - LEFT) / 9, (FRONT - BACK) / 12),
                      0.005,
                      0.006, 0.0035, 1.5))
    wide, deep = RIGHT - LEFT, FRONT - BACK
    grout.merge(plane((LEFT, 0, BACK), (wide, 0, 0), (0, TOP, 0)))
    grout.merge(plane((LEFT, 0, FRONT), (0, 0, -deep), (0, TOP, 0)))
    grout.merge(plane((RIGHT, 0, BACK), (0, 0, deep), (0, TOP, 0)))
    grout.merge(plane((RIGHT, 0, FRONT), (-wide, 0, 0), (0, TOP, 0)))
    grout.merge(plane((LEFT, TOP, BACK), (wide, 0, 0), (0, 0, deep)))
    grout.merge(plane((LEFT, 0, FRONT), (wide, 0, 0), (0, 0, -deep)))
    for mesh, name in ((plain, "tiles.ply"), (blue, "tiles_band.ply"), (floor, "tiles_floor.ply"),
                       (grout, "walls.ply")):
        mesh.write(__file__, name)


def squircle(half, count, p, y, middle):
    """A rounded rectangle around a point, level."""
    def power(v):
        return math.copysign(abs(v) ** (2 / p), v)
    return [(middle[0] + half[0] * power(math.cos(a)), y, middle[1] + half[1] * power(math.sin(a)))
            for a in (2 * math.pi * k / count for k in range(count))]


def washstand(wood, ceramic, chrome):
    x0, x1, z0, z1 = -0.98, 0.08, BACK + 0.01, -0.72
    wood.merge(block((x0, x1), (0.12, 0.78), (z0, z1)))
    for k in range(2):
        a = x0 + 0.02 + k * 0.515
        wood.merge(block((a, a + 0.505), (0.15, 0.75), (z1, z1 + 0.02), 0.006))
        chrome.merge(revolve(smooth([(0.0, 0.0), (0.008, 0.0), (0.007, 0.012), (0.015, 0.02), (0.014, 0.028),
                                     (0.0, 0.032)], 3), 20)
                     .moved((-0.5 if k == 0 else -0.4, 0.6, z1 + 0.02), (0, 90)))
    ceramic.merge(block((x0 - 0.015, x1 + 0.015), (0.78, 0.815), (z0, z1 + 0.025), 0.012, 4))
    bowl = smooth([(0.0, 0.0), (0.09, 0.0), (0.15, 0.03), (0.2, 0.1), (0.212, 0.135), (0.207, 0.142),
                   (0.199, 0.135), (0.185, 0.1),
                   (0.135, 0.04), (0.08, 0.02), (0.03, 0.016), (0.0, 0.016)], 4)
    ceramic.merge(revolve(bowl, 48).moved((-0.45, 0.815, -0.94)))
    # The tap: a swan's neck and two levers.
    base = smooth([(0.032, 0.0), (0.032, 0.006), (0.02, 0.015), (0.016, 0.03), (0.0135, 0.05)], 3)
    chrome.merge(revolve(base, 32).moved((-0.45, 0.815, -1.155)))
    neck = curve([(-0.45, 0.855, -1.155), (-0.45, 0.98, -1.155), (-0.45, 1.055, -1.14), (-0.45, 1.085, -1.09),
                  (-0.45, 1.065, -1.04),
                  (-0.45, 1.03, -1.022)], 8)
    chrome.merge(tube(neck, 0.0125, 20))
    for side in (-1, 1):
        x = -0.45 + side * 0.1
        chrome.merge(revolve(base, 28).moved((x, 0.815, -1.155)))
        chrome.merge(revolve(smooth([(0.0, 0.0), (0.014, 0.0), (0.019, 0.012), (0.014, 0.026), (0.0, 0.03)], 3), 28)
                     .moved((x, 0.86, -1.155)))
        chrome.merge(tube([(x, 0.876, -1.155), (x + side * 0.03, 0.88, -1.15), (x + side * 0.065, 0.892, -1.145)],
                          lambda t: 0.0055 + 0.003 * t, 12))
    # Round the mirror.
    chrome.merge(ring(0.37, 0.012, 72, 12).moved((-0.45, 1.5, BACK + 0.03), (0, 90)))


def tub(ceramic, chrome):
    middle, half = (0.93, -0.27), (0.34, 0.88)
    levels = [(0.86, 0.95, 0.0, 5), (0.9, 0.96, 0.06, 5), (0.97, 0.99, 0.42, 5), (0.985, 0.995, 0.5, 5),
              (1.03, 1.02, 0.54, 5),
              (1.04, 1.025, 0.555, 5), (1.03, 1.02, 0.57, 5), (0.93, 0.965, 0.572, 5), (0.87, 0.94, 0.565, 4.5),
              (0.84, 0.92, 0.54, 4.5),
              (0.8, 0.89, 0.4, 4), (0.72, 0.84, 0.22, 3.5), (0.6, 0.75, 0.14, 3), (0.3, 0.4, 0.12, 2.5),
              (0.0, 0.0, 0.12, 2)]
    rows = [squircle((half[0] * a, half[1] * b), 72, p, y, middle) for a, b, y, p in curve(levels, 3)]
    ceramic.merge(Mesh().grid(rows, wrap_columns=True, flip=True))
    # Its tap, and the shower on a rail.
    wall = BACK
    chrome.merge(tube(curve([(0.93, 0.8, wall), (0.93, 0.8, wall + 0.1), (0.93, 0.79, wall + 0.16),
                             (0.93, 0.75, wall + 0.18)], 6), 0.019, 20))
    for x in (0.8, 1.06):
        chrome.merge(revolve(smooth([(0.03, 0.0), (0.03, 0.01), (0.016, 0.02), (0.014, 0.05), (0.024, 0.06),
                                     (0.026, 0.085), (0.018, 0.095),
                                     (0.0, 0.097)], 3), 28).moved((x, 0.8, wall), (0, 90)))
    rail = 0.68
    chrome.merge(tube([(rail, 0.95 + 0.11 * k, wall + 0.06) for k in range(11)], 0.0105, 16))
    for y in (0.98, 2.02):
        chrome.merge(tube([(rail, y, wall), (rail, y, wall + 0.06)], 0.012, 14))
    # The head leans forward; the hose hangs down from it.
    chrome.merge(tube(curve([(rail, 1.72, wall + 0.075), (rail, 1.82, wall + 0.1), (rail, 1.9, wall + 0.15)], 6),
                      lambda t: 0.011 + 0.006 * t, 16))
    head = revolve(smooth([(0.0, 0.0), (0.05, 0.0), (0.058, 0.008), (0.05, 0.022), (0.02, 0.034), (0.0, 0.036)], 4),
                   40)
    chrome.merge(head.moved((0, 0, 0), (0, 25)).moved((rail, 1.905, wall + 0.185)))
    hose = curve([(rail, 1.72, wall + 0.075), (rail + 0.01, 1.5, wall + 0.08), (rail + 0.07, 1.1, wall + 0.07),
                  (rail + 0.13, 0.87, wall + 0.07),
                  (rail + 0.2, 0.82, wall + 0.06), (0.92, 0.84, wall + 0.06)], 24)
    count = len(hose)
    chrome.merge(tube(hose, lambda t: 0.0075 + 0.0012 * math.sin(math.pi * round(t * (count - 1)) / 2), 10))


def towel_rail(chrome, cloth):
    x, z0, z1 = LEFT + 0.09, -0.62, -0.02
    for y in (0.8, 1.02, 1.24, 1.46):
        chrome.merge(tube([(x, y, mix(z0, z1, k / 8)) for k in range(9)], 0.0105, 16))
    for z in (z0, z1):
        chrome.merge(tube([(x, 0.7 + 0.11 * k, z) for k in range(9)], 0.014, 16))
        for y in (0.78, 1.5):
            chrome.merge(tube([(LEFT, y, z), (x, y, z)], 0.009, 12))
    # A towel over one of the bars.
    rows = []
    for i in range(49):
        s = i / 48 * 1.05 - 0.5
        row = []
        for j in range(33):
            z = mix(z0 + 0.08, z1 - 0.12, j / 32)
            fall = smoothstep(0.02, 0.5, abs(s))
            wave = 0.012 * fall * math.sin(j / 32 * 15 + 0.6) + 0.005 * fall * math.sin(j * 1.1 + s * 4)
            if abs(s) < 0.025:
                a = s / 0.025 * math.pi / 2
                p = (x + 0.016 * math.sin(a), 1.24 + 0.016 * math.cos(a), z)
            else:
                side = math.copysign(1, s)
                p = (x + side * (0.016 + 0.01 * fall) + wave, 1.24 - (abs(s) - 0.025),
                     z + 0.012 * fall * math.sin(j * 0.5))
            row.append(p)
        rows.append(row)
    cloth.grid(rows, flip=True)


def lamps(chrome, glass, bulbs):
    for x in (-0.98, 0.08):
        z = BACK + 0.15
        chrome.merge(revolve(smooth([(0.05, 0.0), (0.05, 0.01), (0.03, 0.02), (0.0, 0.024)], 3),
                             32).moved((x, 1.42, BACK), (0, 90)))
        chrome.merge(tube(curve([(x, 1.42, BACK), (x, 1.42, BACK + 0.08), (x, 1.44, z - 0.02), (x, 1.475, z)], 6),
                          0.009, 14))
        chrome.merge(revolve(smooth([(0.0, 1.475), (0.03, 1.475), (0.045, 1.485), (0.047, 1.5), (0.04, 1.503),
                                     (0.0, 1.503)], 3), 36)
                     .moved((x, 0, z)))
        # A shade open at the top: outside, rim, inside.
        out = smooth([(0.03, 1.504), (0.07, 1.52), (0.088, 1.57), (0.084, 1.63), (0.064, 1.68), (0.055, 1.71),
                      (0.052, 1.713), (0.05, 1.71),
                      (0.06, 1.675), (0.079, 1.627), (0.083, 1.572), (0.066, 1.526), (0.03, 1.509), (0.03, 1.504)],
                      5)
        glass.merge(revolve(out, 40).moved((x, 0, z)))
        ball = [(0.028 * math.cos(a) if 0 < k < 10 else 0.0, 1.585 + 0.034 * math.sin(a)) for k, a in
                ((k, math.pi * (k / 10 - 0.5)) for k in range(11))]
        bulbs.merge(revolve(ball, 20).moved((x, 0, z)))


def small_things(ceramic, bottles):
    beaker = smooth([(0.0, 0.0), (0.03, 0.0), (0.036, 0.01), (0.04, 0.09), (0.0385, 0.092), (0.037, 0.09),
                     (0.033, 0.012), (0.0, 0.008)], 3)
    ceramic.merge(revolve(beaker, 36).moved((-0.12, 0.815, -1.02)))
    ceramic.merge(revolve(smooth([(0.0, 0.0), (0.05, 0.0), (0.065, 0.015), (0.062, 0.018), (0.045, 0.008),
                                  (0.0, 0.006)], 3), 36)
                  .moved((-0.78, 0.815, -0.86)))
    for x, z, s in ((-0.82, -1.06, 1.0), (-0.73, -1.1, 0.75)):
        flask = smooth([(0.0, 0.0), (0.032, 0.0), (0.036, 0.01), (0.036, 0.12), (0.03, 0.14), (0.012, 0.15),
                        (0.011, 0.17), (0.016, 0.172),
                        (0.016, 0.2), (0.0, 0.203)], 4)
        bottles.merge(revolve(flask, 40).moved((x, 0.815, z), scale=(s, s, s)))
    bottles.merge(tube([(-0.115, 0.83, -1.02), (-0.09, 0.98, -1.03)], 0.005, 10))
    soap = rounded_box((0.07, 0.025, 0.045), 0.0115, 5)
    bottles.merge(soap.moved((-0.78, 0.838, -0.86), (1, 20)))


def main():
    walls()
    wood, ceramic, chrome, cloth, glass, bulbs, bottles = (Mesh() for _ in range(7))
    washstand(wood, ceramic, chrome)
    tub(ceramic, chrome)
    towel_rail(chrome, cloth)
    lamps(chrome, glass, bulbs)
    small_things(ceramic, bottles)
    for mesh, name in ((wood, "wood"), (ceramic, "ceramic"), (chrome, "chrome"), (cloth, "towel"),
                       (glass, "shades"), (bulbs, "bulbs"),
                       (bottles, "bottles")):
        mesh.write(__file__, name + ".ply")


if __name__ == "__main__":
    main()
