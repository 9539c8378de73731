#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the weapons beside this file. Each stands on its guard, blade up along y, edges along x."""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from geometry import Mesh, curve, dish, mix, revolve, ring, rounded_box, spline, tube  # noqa: E402


def blade(length, width, thickness, bend, fuller, point, back_point=False):
    """width: (share of the length, full width) pairs. bend: how far the point leaves the line."""
    mesh = Mesh()
    steps, columns = 56, 12
    for side in (-1, 1):
        rows = []
        for k in range(steps + 1):
            s = 1 - (1 - k / steps) ** 1.3                 # closer together towards the point
            s = min(s, 0.9995)
            half = spline(width, s) / 2
            if s > point:
                half *= max(1 - ((s - point) / (1 - point)) ** 2, 0.0) ** 0.5 * 0.999 + 0.001
            thin = thickness / 2 * (1 - 0.55 * s) * min(half / (spline(width, s) / 2) * 1.5, 1.0)
            row = []
            for i in range(columns + 1):
                u = math.sin((i / columns - 0.5) * math.pi)
                z = thin * (1 - u * u) + 0.0006
                if fuller:
                    z -= thin * 0.5 * math.exp(-(u / 0.3) ** 2) * (1 - (s / 0.75) ** 4 if s < 0.75 else 0)
                x = half * u
                if back_point:                             # the point is on the back's side
                    x += (spline(width, s) / 2 - half) * -0.8
                row.append((x + bend * s * s - bend * 0.5 * s, length * s, side * z))
            rows.append(row)
        mesh.grid(rows, flip=side < 0)
    return mesh


def ball(radius, y):
    return revolve([(radius * math.cos(a) if 0 < k < 12 else 0.0, y + radius * math.sin(a))
                    for k, a in ((k, math.pi * (k / 12 - 0.5)) for k in range(13))], 28)


def grip(bottom, top, radius, turns):
    """Wound with wire: ripples along it."""
    steps = turns * 8
    profile = []
    for k in range(steps + 1):
        t = k / steps
        belly = 1 - 0.25 * (2 * t - 1) ** 2
        profile.append((radius * belly * (1 + 0.07 * math.sin(2 * math.pi * turns * t)), mix(bottom, top, t)))
    return revolve(profile, 20)


def main():
    # A long sword: straight, with a fuller and a cross for a guard.
    blade(0.95, [(0, 0.055), (1, 0.032)], 0.013, 0.0, True, 0.85).write(__file__, "sword_blade.ply")
    hilt = tube(curve([(-0.125, 0.018, 0), (-0.07, -0.008, 0), (0, -0.012, 0), (0.07, -0.008, 0),
                       (0.125, 0.018, 0)], 8),
                lambda t: 0.0085 + 0.006 * abs(2 * t - 1) ** 4, 14, round_ends=5)
    hilt.merge(ball(0.027, -0.23))
    hilt.write(__file__, "sword_hilt.ply")
    grip(-0.21, -0.014, 0.0165, 11).write(__file__, "sword_grip.ply")

    # A sabre: curved, with a bow round the hand.
    blade(0.86, [(0, 0.034), (0.75, 0.034), (1, 0.028)], 0.009, 0.17, True, 0.86, True).write(__file__,
                                                                                              "sabre_blade.ply")
    bow = curve([(0.06, 0.0, 0), (0.0, -0.006, 0), (-0.05, -0.012, 0), (-0.075, -0.05, 0), (-0.072, -0.11, 0),
                 (-0.03, -0.155, 0), (0.012, -0.165, 0)], 8)
    hilt = tube(bow, 0.0075, 12, round_ends=5)
    hilt.merge(ball(0.02, -0.165))
    hilt.merge(revolve([(0.0, -0.012), (0.036, -0.01), (0.04, -0.006), (0.036, 0.0), (0.0, 0.003)], 32))
    hilt.write(__file__, "sabre_hilt.ply")
    grip(-0.155, -0.008, 0.0145, 9).write(__file__, "sabre_grip.ply")

    # A katana: a slighter curve, a round guard.
    blade(0.74, [(0, 0.032), (1, 0.023)], 0.0095, 0.075, False, 0.93, True).write(__file__, "katana_blade.ply")
    hilt = revolve([(0.0, -0.006), (0.034, -0.006), (0.039, -0.004), (0.041, 0.0), (0.039, 0.004), (0.034, 0.005),
                    (0.0, 0.005)], 40)
    hilt.merge(ball(0.016, -0.255))
    hilt.write(__file__, "katana_hilt.ply")
    grip(-0.25, -0.006, 0.0155, 13).write(__file__, "katana_grip.ply")

    # A round shield, its boss towards +y.
    shield = revolve([(0.0, -0.012), (0.24, -0.012), (0.262, -0.006), (0.27, 0.004), (0.262, 0.014), (0.25, 0.012),
                      (0.235, 0.009),
                      (0.2, 0.022), (0.15, 0.035), (0.1, 0.043), (0.075, 0.047), (0.072, 0.058), (0.06, 0.08),
                      (0.035, 0.097),
                      (0.0, 0.103)], 72)
    shield.merge(ring(0.2, 0.007, 72, 10).moved((0, 0.024, 0)))
    for k in range(12):
        a = 2 * math.pi * k / 12
        shield.merge(ball(0.01, 0.0).moved((0.246 * math.cos(a), 0.013, 0.246 * math.sin(a))))
    shield.write(__file__, "shield.ply")

    dish(0.16, 0.03).write(__file__, "dish.ply")

    # Blocks that hold what stands, and the stand of the katana.
    stones = Mesh()
    for x in (-0.52, 0.52):
        stones.merge(rounded_box((0.26, 0.14, 0.22), 0.02).moved((x, 0.07, -0.12)))
    stones.write(__file__, "stones.ply")
    stand = rounded_box((0.56, 0.03, 0.15), 0.008).moved((0, 0.015, 0.34))
    for x in (-0.2, 0.2):
        stand.merge(tube([(x, 0.02, 0.34), (x, 0.112, 0.34)], 0.011, 12))
        stand.merge(tube(curve([(x, 0.15, 0.305), (x, 0.128, 0.315), (x, 0.118, 0.34), (x, 0.128, 0.365),
                                (x, 0.15, 0.375)], 6),
                         0.007, 12))
    stand.write(__file__, "stand.ply")


if __name__ == "__main__":
    main()
