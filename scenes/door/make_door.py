#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the room, the door, the table and a teapot beside this file: metres, the floor at y = 0."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from geometry import Mesh, block, curve, plane, revolve, rounded_box, spline, tube  # noqa: E402

DOOR = (0.45, 1.35, 2.05)        # from, to, height of the opening
AJAR = 38                        # degrees


def teapot():
    """Stands on the origin, its spout towards +x; 0.17 high without the knob."""
    profile = curve([(0.0, 0.004, 0), (0.05, 0.004, 0), (0.066, 0.0, 0), (0.072, 0.006, 0), (0.088, 0.028, 0),
                     (0.108, 0.065, 0),
                     (0.106, 0.1, 0), (0.09, 0.13, 0), (0.07, 0.15, 0), (0.066, 0.158, 0), (0.06, 0.16, 0),
                     (0.05, 0.158, 0)], 5)
    mesh = revolve([(max(r, 0.0), y) for r, y, _ in profile], 56)
    lid = curve([(0.064, 0.158, 0), (0.065, 0.163, 0), (0.058, 0.169, 0), (0.035, 0.179, 0), (0.015, 0.185, 0),
                 (0.009, 0.191, 0),
                 (0.012, 0.2, 0), (0.019, 0.208, 0), (0.016, 0.219, 0), (0.006, 0.2245, 0), (0.0, 0.225, 0)], 4)
    mesh.merge(revolve([(max(r, 0.0), y) for r, y, _ in lid], 44))

    # The spout: a bend that narrows, turned in at its mouth.
    bend = curve([(0.08, 0.055, 0), (0.118, 0.068, 0), (0.148, 0.1, 0), (0.16, 0.135, 0), (0.178, 0.158, 0),
                  (0.19, 0.166, 0)], 8)
    width = [(0, 0.031), (0.3, 0.024), (0.65, 0.0155), (0.9, 0.0135), (1, 0.016)]
    mesh.merge(tube(bend, lambda t: spline(width, t), 24, round_ends=0))
    # Its inside, so that the mouth has a rim.
    inside = tube(bend[-14:], mouth_radius, 20, round_ends=0)
    inside.faces = [f[::-1] for f in inside.faces]
    inside.vertices = [(*v[:3], -v[3], -v[4], -v[5]) for v in inside.vertices]
    mesh.merge(inside)

    handle = curve([(-0.09, 0.132, 0), (-0.12, 0.146, 0), (-0.155, 0.135, 0), (-0.166, 0.1, 0), (-0.148, 0.066, 0),
                    (-0.118, 0.046, 0),
                    (-0.092, 0.044, 0)], 8)
    return mesh.merge(tube(handle, lambda t: 0.0095 + 0.003 * (2 * t - 1) ** 2, 18, round_ends=0))


def mouth_radius(t):
    """Of the spout's inside, which meets the outside at the mouth."""
    return 0.0105 + 0.0055 * t ** 6


def room():
    walls = Mesh()
    left, right, bottom, top = -2.0, 1.9, 0.0, 2.5
    back, front = -1.9, 2.8

    walls.merge(plane((left, bottom, front), (0, 0, back - front), (0, top, 0)))
    walls.merge(plane((right, bottom, back), (0, 0, front - back), (0, top, 0)))
    walls.merge(plane((right, bottom, front), (left - right, 0, 0), (0, top, 0)))
    walls.merge(plane((left, top, back), (right - left, 0, 0), (0, 0, front - back)))
    # The wall with the opening has a thickness.
    walls.merge(block((left - 0.3, DOOR[0]), (-0.05, top + 0.2), (back - 0.14, back)))
    walls.merge(block((DOOR[1], right + 1.9), (-0.05, top + 0.2), (back - 0.14, back)))
    walls.merge(block((DOOR[0] - 0.05, DOOR[1] + 0.05), (DOOR[2], top + 0.2), (back - 0.14, back)))
    # The corridor behind it.
    far, end0, end1 = back - 1.6, -1.2, 3.4
    walls.merge(plane((end0, bottom, far), (end1 - end0, 0, 0), (0, top, 0)))
    walls.merge(plane((end0, bottom, back), (0, 0, far - back), (0, top, 0)))
    walls.merge(plane((end1, bottom, far), (0, 0, back - far), (0, top, 0)))
    walls.merge(plane((end0, top, far), (end1 - end0, 0, 0), (0, 0, back - far)))
    walls.write(__file__, "walls.ply")

    wood = Mesh()
    for x in (DOOR[0] - 0.09, DOOR[1]):
        wood.merge(block((x, x + 0.09), (0, DOOR[2] + 0.09), (back - 0.02, back + 0.025)))
    wood.merge(block((DOOR[0] - 0.09, DOOR[1] + 0.09), (DOOR[2], DOOR[2] + 0.09), (back - 0.02, back + 0.026)))
    for x0, x1 in ((left, DOOR[0] - 0.09), (DOOR[1] + 0.09, right)):
        wood.merge(block((x0, x1), (0, 0.09), (back - 0.01, back + 0.018)))
    wood.merge(block((left - 0.01, left + 0.018), (0, 0.09), (back, front)))
    wood.merge(block((DOOR[0] - 0.01, DOOR[0] + 0.03), (0, DOOR[2]),
                     (back - 0.1, back + 0.02)))  # closes the hinge's gap
    # A door with four panels, turned about its left edge.
    leaf, handle = Mesh(), Mesh()
    width = DOOR[1] - DOOR[0] - 0.01
    leaf.merge(block((0, width), (0.005, DOOR[2] - 0.01), (-0.04, 0.0)))
    for x in (0.1, width / 2 + 0.04):
        for y0, y1 in ((0.2, 0.85), (1.05, 1.85)):
            leaf.merge(block((x, x + width / 2 - 0.14), (y0, y1), (-0.055, 0.015), 0.02, 4))
    for side in (-1, 1):
        z = -0.02 + side * 0.02
        handle.merge(tube([(width - 0.07, 1.0, z), (width - 0.07, 1.0, z + side * 0.05)], 0.009, 14))
        handle.merge(tube(curve([(width - 0.07, 1.0, z + side * 0.05), (width - 0.13, 1.002, z + side * 0.053),
                                 (width - 0.19, 0.995, z + side * 0.05)], 8), 0.0095, 14))
        handle.merge(rounded_box((0.045, 0.2, 0.012), 0.005).moved((width - 0.07, 0.97, z)))
    place = {"offset": (DOOR[0], 0, back + 0.02), "rotate": (1, -AJAR)}
    wood.merge(leaf.moved(**place)).write(__file__, "door.ply")
    handle.moved(**place).write(__file__, "handle.ply")


def furniture():
    table = Mesh()
    table.merge(block((-1.25, 0.35), (0.71, 0.75), (-1.15, -0.2), 0.012, 4))
    table.merge(block((-1.15, 0.25), (0.6, 0.71), (-1.05, -0.3)))
    for x in (-1.17, 0.27):
        for z in (-1.07, -0.28):
            table.merge(revolve([(0.0, 0.0), (0.02, 0.0), (0.024, 0.05), (0.03, 0.3), (0.042, 0.55), (0.045, 0.62),
                                 (0.0, 0.62)],
                                24).moved((x, 0, z)))
    table.write(__file__, "table.ply")
    frame, picture = Mesh(), Mesh()
    for x0, x1, y0, y1 in ((-1.25, -0.25, 1.9, 1.96), (-1.25, -0.25, 1.24, 1.3), (-1.25, -1.19, 1.24, 1.96),
                           (-0.31, -0.25, 1.24, 1.96)):
        frame.merge(block((x0, x1), (y0, y1), (-1.91, -1.865), 0.012, 4))
    picture.grid([[(-1.2, 1.28, -1.885), (-0.3, 1.28, -1.885)], [(-1.2, 1.92, -1.885), (-0.3, 1.92, -1.885)]])
    frame.write(__file__, "frame.ply")
    picture.write(__file__, "picture.ply")


def main():
    teapot().write(__file__, "teapot.ply")
    room()
    furniture()


if __name__ == "__main__":
    main()
