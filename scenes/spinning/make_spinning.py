#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the parts of the fan, the flywheel and the top beside this file. What spins does so about y."""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from geometry import Mesh, circle, curve, dish, mix, revolve, rounded_box, smoothstep, tube  # noqa: E402


def fan_blades():
    mesh = Mesh()
    for blade in range(4):
        turn = math.pi / 2 * blade
        for side in (-1, 1):
            rows = []
            for i in range(25):
                r = mix(0.045, 0.37, i / 24)
                share = i / 24
                # As wide as a petal, less steep the farther out.
                reach = mix(0.45, 0.62, share) * (1 - 0.55 * smoothstep(0.72, 1.0, share) ** 2)
                row = []
                for j in range(17):
                    u = j / 8 - 1
                    a = turn + reach * u + 0.25 * share
                    y = mix(0.06, 0.035, share) * u * 1.2 + 0.015 * (1 - u * u)
                    edge = 0.0018 * (1 - u ** 4)
                    row.append((r * math.cos(a), y + side * edge, -r * math.sin(a)))
                rows.append(row)
            mesh.grid(rows, flip=side > 0)
    nose = [(0.0, -0.06), (0.075, -0.06), (0.08, -0.03), (0.075, 0.04), (0.055, 0.075), (0.025, 0.09), (0.0, 0.093)]
    return mesh.merge(revolve(nose, 48))


def fan_cage():
    """The axis of the fan is y here too; the front is up."""
    mesh = Mesh()
    mesh.merge(tube(circle(0.42, 72), 0.008, 10, closed=True))
    mesh.merge(tube(circle(0.24, 48, 0.118), 0.005, 8, closed=True))
    mesh.merge(tube(circle(0.07, 32, 0.135), 0.007, 8, closed=True))
    mesh.merge(revolve([(0.0, 0.13), (0.065, 0.13), (0.068, 0.137), (0.06, 0.142), (0.0, 0.144)], 32))
    for k in range(24):
        a = 2 * math.pi * k / 24
        c, s = math.cos(a), math.sin(a)
        front = curve([(0.42 * c, 0.0, 0.42 * s), (0.4 * c, 0.06, 0.4 * s), (0.3 * c, 0.11, 0.3 * s),
                       (0.07 * c, 0.135, 0.07 * s)], 5)
        mesh.merge(tube(front, 0.0032, 6, round_ends=0))
        if k % 2 == 0:
            back = curve([(0.42 * c, 0.0, 0.42 * s), (0.4 * c, -0.06, 0.4 * s), (0.3 * c, -0.1, 0.3 * s),
                          (0.08 * c, -0.12, 0.08 * s)], 5)
            mesh.merge(tube(back, 0.0032, 6, round_ends=0))
    return mesh


def fan_stand():
    """The fan's middle is at the origin, its front towards +z, the table at y = -0.62."""
    mesh = revolve([(0.0, -0.24), (0.06, -0.24), (0.09, -0.22), (0.1, -0.15), (0.095, -0.08), (0.06, -0.07),
                    (0.0, -0.07)],
                   40).moved(rotate=(0, 90))
    mesh.merge(tube(curve([(0, -0.58, -0.15), (0, -0.4, -0.17), (0, -0.2, -0.18), (0, -0.05, -0.17)], 8), 0.024,
                    20))
    mesh.merge(revolve([(0.23, -0.62), (0.235, -0.61), (0.225, -0.59), (0.12, -0.565), (0.05, -0.54), (0.03, -0.5),
                        (0.0, -0.49)],
                       56).moved((0, 0, -0.14)))
    return mesh


def flywheel():
    """A scalloped rim, whose hollows gather the light, on three spokes."""
    lobes, segments, height = 9, 270, 0.085
    profile = [(0.0, 0.0), (0.0, 1.0), (0.006, 1.03), (0.022, 1.06), (0.038, 1.03), (0.044, 1.0), (0.044, 0.0),
               (0.038, -0.03), (0.022, -0.06), (0.006, -0.03)]
    dense = []
    for (a, b), (c, d) in zip(profile, profile[1:] + profile[:1]):
        steps = 8 if abs(d - b) > 0.5 else 1
        dense += [(mix(a, c, k / steps), mix(b, d, k / steps)) for k in range(steps)]
    rows = []
    for k in range(segments):
        t = 2 * math.pi * k / segments
        wave = 0.3 * (1 + 0.075 * math.cos(lobes * t))
        rows.append([((wave + r) * math.cos(t), height * (y - 0.5), (wave + r) * math.sin(t)) for r, y in dense])
    mesh = Mesh().grid(rows, wrap_rows=True, wrap_columns=True, flip=True)
    mesh.merge(revolve([(0.0, -0.04), (0.04, -0.04), (0.048, -0.02), (0.048, 0.02), (0.04, 0.045), (0.015, 0.06),
                        (0.0, 0.062)], 32))
    for k in range(3):
        t = 2 * math.pi * k / 3
        mesh.merge(tube([((0.03 + 0.28 * i / 8) * math.cos(t), 0,
                          (0.03 + 0.28 * i / 8) * math.sin(t)) for i in range(9)],
                        lambda s: 0.016 - 0.006 * math.sin(math.pi * s), 14, round_ends=0))
    return mesh


def top():
    """Fluted, on its tip at the origin."""
    profile = [(0.0, 0.0), (0.012, 0.008), (0.03, 0.035), (0.075, 0.085), (0.13, 0.125), (0.15, 0.15),
               (0.145, 0.172), (0.1, 0.188),
               (0.05, 0.196), (0.024, 0.21), (0.015, 0.24), (0.014, 0.3), (0.02, 0.32), (0.016, 0.335), (0.0, 0.34)]
    points = curve([(r, y, 0.0) for r, y in profile], 4)
    rows = []
    for r, y, _ in points:
        deep = 0.09 * smoothstep(0.03, 0.1, r)
        rows.append([(max(r, 0.0) * (1 - deep * (0.5 + 0.5 * math.cos(8 * t))) * math.cos(t), y,
                      -max(r, 0.0) * (1 - deep * (0.5 + 0.5 * math.cos(8 * t))) * math.sin(t))
                     for t in (2 * math.pi * k / 72 for k in range(72))])
    return Mesh().grid(rows, wrap_columns=True)


def main():
    fan_blades().write(__file__, "fan_blades.ply")
    fan_cage().write(__file__, "fan_cage.ply")
    fan_stand().write(__file__, "fan_stand.ply")
    flywheel().write(__file__, "flywheel.ply")
    axle = revolve([(0.1, 0.0), (0.1, 0.012), (0.085, 0.02), (0.03, 0.025), (0.012, 0.04), (0.012, 0.1),
                    (0.0, 0.11)], 40)
    axle.write(__file__, "axle.ply")
    top().write(__file__, "top.ply")
    dish(0.2, 0.05).moved(rotate=(0, -90)).write(__file__, "dish.ply")     # opens towards +z
    rounded_box((2.6, 0.06, 1.5), 0.02).moved((0, -0.03, 0.1)).write(__file__, "table.ply")


if __name__ == "__main__":
    main()
