# SPDX-License-Identifier: MIT
"""What the scenes' generators share: meshes made of grids of points, written as binary PLY files.

Only the standard library, and the same numbers always give the same file. Points and vectors are
tuples of three; y is up.
"""

import math
import os
import struct


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return mul(a, 1 / length) if length > 0 else (0.0, 1.0, 0.0)


def mix(a, b, t):
    return a + (b - a) * t


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def spline(knots, x):
    """A smooth curve through (x, y) pairs without overshoot [Fritsch, Carlson 1980]."""
    if x <= knots[0][0]:
        return knots[0][1]
    if x >= knots[-1][0]:
        return knots[-1][1]
    slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(knots, knots[1:])]
    tangents = [slopes[0]]
    for a, b in zip(slopes, slopes[1:]):
        tangents.append(2 * a * b / (a + b) if a * b > 0 else 0.0)
    tangents.append(slopes[-1])
    i = max(k for k in range(len(knots) - 1) if knots[k][0] <= x)
    h = knots[i + 1][0] - knots[i][0]
    t = (x - knots[i][0]) / h
    return (knots[i][1] * (1 + 2 * t) * (1 - t) ** 2 + h * tangents[i] * t * (1 - t) ** 2
            + knots[i + 1][1] * t * t * (3 - 2 * t) + h * tangents[i + 1] * t * t * (t - 1))


class Mesh:
    """Vertices (x, y, z, nx, ny, nz) and faces of three or four of them, all convex and flat enough."""

    def __init__(self):
        self.vertices, self.faces = [], []

    def grid(self, rows, normals=None, wrap_rows=False, wrap_columns=False, flip=False, keep=None):
        """A surface through rows of points, smooth but at its borders. Its outside is where the row's
        direction x the direction from row to row points, or the other way with flip. keep(i, j) says
        which quadrilaterals there are, for a surface of several materials."""
        height, width = len(rows), len(rows[0])
        if normals is None:
            normals = grid_normals(rows, wrap_rows, wrap_columns, flip)
        index = {}

        def vertex(i, j):
            i, j = i % height, j % width
            if (i, j) not in index:
                index[i, j] = len(self.vertices)
                self.vertices.append((*rows[i][j], *normals[i][j]))
            return index[i, j]

        for i in range(height if wrap_rows else height - 1):
            for j in range(width if wrap_columns else width - 1):
                if keep is not None and not keep(i, j):
                    continue
                corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
                if flip:
                    corners.reverse()
                face, seen = [], []
                for a, b in corners:
                    point = rows[a % height][b % width]
                    if all(dot(sub(point, p), sub(point, p)) > 1e-16 for p in seen):
                        seen.append(point)
                        face.append(vertex(a, b))
                if len(face) >= 3:
                    self.faces.append(tuple(face))
        return self

    def merge(self, other):
        first = len(self.vertices)
        self.vertices += other.vertices
        self.faces += [tuple(first + k for k in face) for face in other.faces]
        return self

    def moved(self, offset=(0, 0, 0), rotate=(0, 0), scale=(1, 1, 1)):
        """A copy, scaled, then turned about an axis (0, 1, 2) by an angle in degrees, then moved."""
        axis, angle = rotate[0], math.radians(rotate[1])
        c, s = math.cos(angle), math.sin(angle)
        first, second = (axis + 1) % 3, (axis + 2) % 3

        def turned(v):
            out = list(v)
            out[first] = c * v[first] - s * v[second]
            out[second] = s * v[first] + c * v[second]
            return tuple(out)

        mesh = Mesh()
        for v in self.vertices:
            p = tuple(v[i] * scale[i] for i in range(3))
            n = unit(tuple(v[3 + i] / scale[i] for i in range(3)))
            mesh.vertices.append((*add(turned(p), offset), *turned(n)))
        mirrored = scale[0] * scale[1] * scale[2] < 0
        mesh.faces = [tuple(reversed(f)) if mirrored else f for f in self.faces]
        return mesh

    def check(self):
        """Every face is on its normals' side, so that inside and outside are what they seem."""
        for face in self.faces:
            points = [self.vertices[k][:3] for k in face]
            n = (0.0, 0.0, 0.0)
            for k in range(1, len(points) - 1):
                n = add(n, cross(sub(points[k], points[0]), sub(points[k + 1], points[0])))
            assert dot(n, n) == 0 or sum(dot(n, self.vertices[k][3:]) for k in face) > 0, face

    def write(self, script, name):
        """Writes NAME beside the script."""
        self.check()
        index = "ushort" if len(self.vertices) <= 65536 else "uint"
        with open(os.path.join(os.path.dirname(os.path.abspath(script)), name), "wb") as out:
            out.write(("ply\n"
                       "format binary_little_endian 1.0\n"
                       f"comment made by {os.path.basename(script)}\n"
                       f"element vertex {len(self.vertices)}\n"
                       + "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz"))
                       + f"element face {len(self.faces)}\n"
                       f"property list uchar {index} vertex_indices\n"
                       "end_header\n").encode("ascii"))
            for vertex in self.vertices:
                # Rounded, so that the last bit of a sine does not show in the file.
                out.write(struct.pack("<6f", *(round(x, 6) + 0.0 for x in vertex)))
            for face in self.faces:
                out.write(struct.pack(f"<B{len(face)}{'H' if index == 'ushort' else 'I'}", len(face), *face))


def grid_normals(rows, wrap_rows, wrap_columns, flip):
    """Normals by differences of neighbours; at poles, by those of the next row or column."""
    height, width = len(rows), len(rows[0])

    def difference(i, j, di, dj):
        a, b = (i - di, j - dj), (i + di, j + dj)
        if di and not wrap_rows:
            a, b = (max(a[0], 0), j), (min(b[0], height - 1), j)
        if dj and not wrap_columns:
            a, b = (i, max(a[1], 0)), (i, min(b[1], width - 1))
        return sub(rows[b[0] % height][b[1] % width], rows[a[0] % height][a[1] % width])

    def normal(i, j):
        along, across = difference(i, j, 0, 1), difference(i, j, 1, 0)
        n = cross(along, across)
        return n if dot(n, n) > 1e-10 * dot(along, along) * dot(across, across) else None

    normals = []
    for i in range(height):
        row = []
        for j in range(width):
            n = normal(i, j)
            if n is None:  # a pole: the mean over the row or column beside it
                beside = ([(1 if i == 0 else i - 1, k) for k in range(width)] if i in (0, height - 1)
                          else [(k, 1 if j == 0 else j - 1) for k in range(height)])
                n = (0.0, 0.0, 0.0)
                for m in (normal(*k) for k in beside):
                    n = add(n, unit(m)) if m else n
            row.append(unit(mul(n, -1) if flip else n))
        normals.append(row)
    return normals


def revolve(profile, segments, flip=False):
    """(radius, height) pairs turned about the y axis; going up, the outside is away from the axis."""
    mesh = Mesh()
    rows = []
    for radius, height in profile:
        rows.append([(radius * math.cos(2 * math.pi * k / segments), height,
                      -radius * math.sin(2 * math.pi * k / segments)) for k in range(segments)])
    return mesh.grid(rows, wrap_columns=True, flip=flip)


def ring(major, minor, segments, sides):
    """A torus about the y axis."""
    rows = []
    for k in range(segments):
        a = 2 * math.pi * k / segments
        rows.append([((major + minor * math.cos(b)) * math.cos(a), minor * math.sin(b),
                      (major + minor * math.cos(b)) * math.sin(a))
                     for b in (2 * math.pi * i / sides for i in range(sides))])
    return Mesh().grid(rows, wrap_rows=True, wrap_columns=True)


def frames(points, closed=False, start=None):
    """At each point of a curve two vectors across it, turned as little as possible along the way."""
    count = len(points)
    tangents = []
    for k in range(count):
        if closed:
            tangents.append(unit(sub(points[(k + 1) % count], points[k - 1])))
        else:
            tangents.append(unit(sub(points[min(k + 1, count - 1)], points[max(k - 1, 0)])))
    across = start or (0.0, 1.0, 0.0)
    if abs(dot(across, tangents[0])) > 0.9:
        across = (1.0, 0.0, 0.0)
    result = []
    for t in tangents:
        across = unit(sub(across, mul(t, dot(across, t))))
        result.append((across, cross(t, across)))
    return result


def tube(points, radius, sides, closed=False, round_ends=4):
    """A round bar along a curve; radius is a number or a function of the share of the way. Half balls
    of round_ends rings close it (0: open ends)."""
    at = radius if callable(radius) else (lambda t: radius)
    across = frames(points, closed)
    count = len(points)
    rings = [(points[k], across[k], at(k / max(count - 1, 1))) for k in range(count)]
    if not closed and round_ends:
        def cap(point, frame, r, outwards):
            return [(add(point, mul(outwards, r * math.sin(a))), frame, r * math.cos(a))
                    for a in (math.pi / 2 * k / round_ends for k in range(1, round_ends + 1))]
        first = unit(sub(points[0], points[1]))
        last = unit(sub(points[-1], points[-2]))
        rings = (cap(points[0], across[0], rings[0][2], first)[::-1] + rings
                 + cap(points[-1], across[-1], rings[-1][2], last))
    rows = []
    for point, (a, b), r in rings:
        rows.append([add(point, add(mul(a, r * math.cos(t)), mul(b, r * math.sin(t))))
                     for t in (2 * math.pi * i / sides for i in range(sides))])
    return Mesh().grid(rows, wrap_rows=closed, wrap_columns=True)


def rounded_box(size, radius, steps=4):
    """A box of this size around the origin with rounded edges."""
    half = [s / 2 - radius for s in size]
    rows, normals = [], []
    for side, start in ((-1, -90), (1, 0)):
        for i in range(steps + 1):
            latitude = math.radians(start + 90 * i / steps)
            row, row_normals = [], []
            for quadrant in range(4):
                corner = ((1, -1, -1, 1)[quadrant] * half[0], side * half[1],
                          (1, 1, -1, -1)[quadrant] * half[2])
                for j in range(steps + 1):
                    longitude = math.radians(90 * (quadrant + j / steps))
                    n = (math.cos(latitude) * math.cos(longitude), math.sin(latitude),
                         math.cos(latitude) * math.sin(longitude))
                    row.append(add(corner, mul(n, radius)))
                    row_normals.append(n)
            rows.append(row)
            normals.append(row_normals)
    mesh = Mesh().grid(rows, normals, wrap_columns=True, flip=True)
    for side in (-1, 1):
        first = len(mesh.vertices)
        y = side * size[1] / 2
        for x, z in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            mesh.vertices.append((x * half[0], y, z * half[2], 0.0, float(side), 0.0))
        face = tuple(first + k for k in range(4))
        mesh.faces.append(face if side < 0 else face[::-1])
    return mesh


def circle(radius, count, y=0.0):
    """Points around the y axis."""
    return [(radius * math.cos(2 * math.pi * k / count), y, radius * math.sin(2 * math.pi * k / count))
            for k in range(count)]


def curve(knots, steps):
    """A Catmull-Rom curve through points, with this many steps between two of them."""
    points = []
    count = len(knots)
    for i in range(count - 1):
        a, b, c, d = knots[max(i - 1, 0)], knots[i], knots[i + 1], knots[min(i + 2, count - 1)]
        for k in range(steps):
            t = k / steps
            points.append(tuple(
                0.5 * (2 * b[m] + (c[m] - a[m]) * t + (2 * a[m] - 5 * b[m] + 4 * c[m] - d[m]) * t * t
                       + (3 * b[m] - 3 * c[m] + d[m] - a[m]) * t ** 3) for m in range(len(b))))
    points.append(tuple(knots[-1]))
    return points


def smooth(profile, steps):
    """A Catmull-Rom curve through (radius, height) pairs, for revolve."""
    return [(max(r, 0.0), y) for r, y, _ in curve([(r, y, 0.0) for r, y in profile], steps)]


def block(x, y, z, radius=0.008, steps=3):
    """A box with rounded edges between pairs of bounds."""
    return rounded_box((x[1] - x[0], y[1] - y[0], z[1] - z[0]), radius, steps).moved(
        ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2, (z[0] + z[1]) / 2))


def tiles(corner, right, up, columns, rows, size, gap, bevel, height, lean, chosen=lambda i, j: True):
    """Tiles on the plane through corner along right and up, those of chosen(column, row). Their edges fall
    off over bevel by height, and the normals lean outwards there."""
    mesh, out = Mesh(), cross(right, up)
    for j in range(rows):
        for i in range(columns):
            if not chosen(i, j):
                continue
            first = len(mesh.vertices)
            for inset, above, tilt in ((gap / 2, 0.0, lean), (gap / 2 + bevel, height, 0.0)):
                for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    x = (i + a) * size[0] + (inset if a == 0 else -inset)
                    y = (j + b) * size[1] + (inset if b == 0 else -inset)
                    point = add(corner, add(add(mul(right, x), mul(up, y)), mul(out, above)))
                    normal = unit(add(out, add(mul(right, tilt * (2 * a - 1)), mul(up, tilt * (2 * b - 1)))))
                    mesh.vertices.append((*point, *normal))
            mesh.faces.append((first + 4, first + 5, first + 6, first + 7))
            for k in range(4):
                mesh.faces.append((first + k, first + (k + 1) % 4, first + 4 + (k + 1) % 4, first + 4 + k))
    return mesh


def plane(point, right, up):
    """A parallelogram; its outside is where right x up points."""
    return Mesh().grid([[point, add(point, right)], [add(point, up), add(add(point, right), up)]])


def dish(radius, depth, segments=48):
    """A lamp's reflector: a shallow bowl that opens towards -y, its middle at the origin."""
    r = (radius * radius + depth * depth) / (2 * depth)
    inside = [(radius * k / 10, -(r - math.sqrt(r * r - (radius * k / 10) ** 2))) for k in range(11)]
    back = [(x * 1.01, y + 0.04 * radius) for x, y in inside[::-1]]
    return revolve(inside + back, segments)
