#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes ring.ply beside this file: a finger ring of radius 1 standing on the plane y = 0.

The inner wall is a plain cylinder, so that it throws the caustic of a circle; the upper edge is
rounded. Normals are smooth around the ring. The same numbers always give the same file.
"""

import math
import os
import struct

SEGMENTS = 512       # around the ring
EDGE_SEGMENTS = 10   # around the half circle on top
INNER_RADIUS = 1.0
THICKNESS = 0.12
HEIGHT = 0.36
BELOW = 0.01         # the closed underside is sunk into the plane


def profile():
    """Strips of the cross-section: lists of (radius, height, normal outwards, normal upwards)."""
    edge = THICKNESS / 2
    middle = INNER_RADIUS + edge
    outer = INNER_RADIUS + THICKNESS
    wall = HEIGHT - edge
    strip = [(INNER_RADIUS, -BELOW, -1.0, 0.0)]
    for i in range(EDGE_SEGMENTS + 1):
        angle = math.pi * (1 - i / EDGE_SEGMENTS)
        strip.append((middle + edge * math.cos(angle), wall + edge * math.sin(angle),
                      math.cos(angle), math.sin(angle)))
    strip.append((outer, -BELOW, 1.0, 0.0))
    underside = [(outer, -BELOW, 0.0, -1.0), (INNER_RADIUS, -BELOW, 0.0, -1.0)]
    return [strip, underside]


def mesh():
    vertices, triangles = [], []
    for strip in profile():
        first = len(vertices)
        count = len(strip)
        for k in range(SEGMENTS):
            angle = 2 * math.pi * k / SEGMENTS
            c, s = math.cos(angle), math.sin(angle)
            for radius, height, out, up in strip:
                vertices.append((radius * c, height, radius * s, out * c, up, out * s))
        for k in range(SEGMENTS):
            here = first + k * count
            there = first + (k + 1) % SEGMENTS * count
            for i in range(count - 1):
                # Counter-clockwise seen from outside.
                triangles.append((here + i, there + i, there + i + 1))
                triangles.append((here + i, there + i + 1, here + i + 1))
    return vertices, triangles


def check(vertices, triangles):
    """Every triangle faces the way of its normals."""
    for a, b, c in triangles:
        p, q, r = vertices[a], vertices[b], vertices[c]
        u = [q[i] - p[i] for i in range(3)]
        v = [r[i] - p[i] for i in range(3)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for corner in (p, q, r):
            assert sum(n[i] * corner[3 + i] for i in range(3)) > 0


def main():
    vertices, triangles = mesh()
    check(vertices, triangles)
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "ring.ply")
    with open(path, "wb") as out:
        out.write(("ply\n"
                   "format binary_little_endian 1.0\n"
                   "comment made by make_ring.py\n"
                   f"element vertex {len(vertices)}\n"
                   + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
                   + f"element face {len(triangles)}\n"
                   "property list uchar int vertex_indices\n"
                   "end_header\n").encode("ascii"))
        for vertex in vertices:
            out.write(struct.pack("<6f", *vertex))
        for triangle in triangles:
            out.write(struct.pack("<B3i", 3, *triangle))


if __name__ == "__main__":
    main()
