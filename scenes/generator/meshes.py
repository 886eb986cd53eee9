"""Triangle meshes with normals and texture coordinates, the ways this folder's scenes make them, and PLY files.

Space is right-handed with z up; lengths are metres. Normals point out of the body.
"""
import gzip
import math
import struct


class Mesh:
    def __init__(self):
        self.positions, self.normals, self.uvs, self.triangles = [], [], [], []

    def vertex(self, position, normal, uv=(0.0, 0.0)):
        self.positions.append(position)
        self.normals.append(normal)
        self.uvs.append(uv)
        return len(self.positions) - 1

    def quad(self, a, b, c, d):
        """Counter-clockwise seen from outside; corners that coincide leave a triangle or nothing."""
        for triangle in ((a, b, c), (a, c, d)):
            if self.area(triangle) > 1e-14:
                self.triangles.append(triangle)

    def area(self, triangle):
        p, q, r = (self.positions[i] for i in triangle)
        return 0.5 * length(cross(subtract(q, p), subtract(r, p)))

    def add(self, other, move=(0.0, 0.0, 0.0)):
        first = len(self.positions)
        self.positions += [tuple(p[i] + move[i] for i in range(3)) for p in other.positions]
        self.normals += other.normals
        self.uvs += other.uvs
        self.triangles += [tuple(i + first for i in t) for t in other.triangles]
        return self

    def write(self, path, with_uv=True):
        """Binary PLY; gzipped (without a date, so that the same mesh gives the same file) when the name ends in .gz."""
        properties = "x y z nx ny nz" + (" u v" if with_uv else "")
        header = ["ply", "format binary_little_endian 1.0", "element vertex %d" % len(self.positions)]
        header += ["property float " + name for name in properties.split()]
        header += ["element face %d" % len(self.triangles), "property list uchar int vertex_indices", "end_header"]
        data = bytearray(("\n".join(header) + "\n").encode())
        for p, n, uv in zip(self.positions, self.normals, self.uvs):
            # Rounded to binary fractions far below what can be seen: the file is smaller when compressed.
            p = tuple(round(c * 131072) / 131072 for c in p)
            n = tuple(round(c * 8192) / 8192 for c in n)
            data += struct.pack("<6f", *p, *n) + (struct.pack("<2f", *uv) if with_uv else b"")
        for t in self.triangles:
            data += struct.pack("<B3i", 3, *t)
        if path.endswith(".gz"):
            data = gzip.compress(bytes(data), 9, mtime=0)
        with open(path, "wb") as file:
            file.write(data)


def subtract(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


def normalize(a):
    size = length(a)
    return (a[0] / size, a[1] / size, a[2] / size)


def rounded_profile(corners, steps=6):
    """Profile points (r, z, normal r, normal z) along a polyline of (r, z, rounding radius).

    The body lies to the left of the line: from the axis outwards along the bottom, up the outside, in along the top.
    """
    def direction(a, b):
        size = math.hypot(b[0] - a[0], b[1] - a[1])
        return ((b[0] - a[0]) / size, (b[1] - a[1]) / size)

    points = []
    first = direction(corners[0], corners[1])
    points.append((corners[0][0], corners[0][1], first[1], -first[0]))
    for before, corner, after in zip(corners, corners[1:], corners[2:]):
        d0, d1 = direction(before, corner), direction(corner, after)
        n0, n1 = (d0[1], -d0[0]), (d1[1], -d1[0])
        turn = math.atan2(d0[0] * d1[1] - d0[1] * d1[0], d0[0] * d1[0] + d0[1] * d1[1])
        radius = corner[2]
        if radius == 0:
            points += [(corner[0], corner[1], *n0), (corner[0], corner[1], *n1)]
            continue
        tangent = radius * math.tan(abs(turn) / 2)
        start = (corner[0] - d0[0] * tangent, corner[1] - d0[1] * tangent)
        side = 1 if turn > 0 else -1
        center = (start[0] - side * n0[0] * radius, start[1] - side * n0[1] * radius)
        for i in range(steps + 1):
            angle = turn * i / steps
            n = (n0[0] * math.cos(angle) - n0[1] * math.sin(angle), n0[0] * math.sin(angle) + n0[1] * math.cos(angle))
            points.append((center[0] + side * n[0] * radius, center[1] + side * n[1] * radius, *n))
    last = direction(corners[-2], corners[-1])
    points.append((corners[-1][0], corners[-1][1], last[1], -last[0]))
    return points


def smooth_profile(knots, steps=8):
    """The same along a smooth curve through the (r, z) knots (Catmull-Rom)."""
    padded = [knots[0]] + list(knots) + [knots[-1]]
    points = []
    for p0, p1, p2, p3 in zip(padded, padded[1:], padded[2:], padded[3:]):
        for i in range(steps + (p3 is padded[-1] and p2 is padded[-2])):
            t = i / steps
            value, slope = [], []
            for a, b, c, d in zip(p0, p1, p2, p3):
                value.append(0.5 * (2 * b + t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * b - a - 3 * c + d)))))
                slope.append(0.5 * (c - a + t * (2 * (2 * a - 5 * b + 4 * c - d) + 3 * t * (3 * b - a - 3 * c + d))))
            size = math.hypot(*slope)
            points.append((max(value[0], 0.0), value[1], slope[1] / size, -slope[0] / size))
    return points


def revolve(profile, segments):
    """The surface that the profile sweeps about the z axis; u runs around, v along the profile (in metres)."""
    mesh = Mesh()
    lengths = [0.0]
    for a, b in zip(profile, profile[1:]):
        lengths.append(lengths[-1] + math.hypot(b[0] - a[0], b[1] - a[1]))
    for i in range(segments + 1):
        angle = 2 * math.pi * (i % segments) / segments
        c, s = math.cos(angle), math.sin(angle)
        for (r, z, nr, nz), v in zip(profile, lengths):
            mesh.vertex((r * c, r * s, z), (nr * c, nr * s, nz), (i / segments, v))
    count = len(profile)
    for i in range(segments):
        for j in range(count - 1):
            a, b = i * count + j, (i + 1) * count + j
            mesh.quad(a, b, b + 1, a + 1)
    return mesh


def surface(function, columns, rows, wrap_u=False, wrap_v=False, uv_scale=(1.0, 1.0)):
    """A grid over function(u, v) -> position, u and v in [0,1]; outside is where dP/du x dP/dv points."""
    mesh = Mesh()
    step = 1e-4
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            p = function(u % 1 if wrap_u else u, v % 1 if wrap_v else v)
            du = subtract(function(u + step, v), function(u - step, v))
            dv = subtract(function(u, v + step), function(u, v - step))
            mesh.vertex(p, normalize(cross(du, dv)), (u * uv_scale[0], v * uv_scale[1]))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            mesh.quad(a, a + 1, a + columns + 2, a + columns + 1)
    return mesh


def tube(center, radius, columns, rows, wrap=True, reference=None):
    """A tube of `radius` about the curve center(t), t in [0,1], closed or open.

    `reference(t)` is any direction across the curve, turning smoothly with it: what the rings are lined up with.
    """
    step = 1e-4

    def point(u, v):
        p = center(u)
        tangent = normalize(subtract(center(u + step), center(u - step)))
        up = normalize(cross(tangent, reference(u)))
        side = cross(tangent, up)
        angle = 2 * math.pi * v
        return tuple(p[i] + radius * (math.cos(angle) * side[i] + math.sin(angle) * up[i]) for i in range(3))

    return surface(point, columns, rows, wrap, True)


def rounded_box(size, radius, steps=3):
    """A box on the ground plane, centred on the z axis, with rounded edges."""
    half = [size[0] / 2 - radius, size[1] / 2 - radius, size[2] / 2 - radius]
    mesh = Mesh()
    for axis in range(3):
        for sign in (-1, 1):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            # Parameters from -1 to 1 whose outer parts, beyond the flat, sweep 45 degrees of the edge.
            line = [(-1, -math.pi / 4 * (1 - i / steps)) for i in range(steps + 1)]
            line += [(1, math.pi / 4 * i / steps) for i in range(steps + 1)]
            first = len(mesh.positions)
            for sb, angle_b in line:
                for sa, angle_a in line:
                    n = [0.0, 0.0, 0.0]
                    n[axis], n[a], n[b] = sign, math.tan(angle_a), math.tan(angle_b)
                    n = normalize(n)
                    p = [0.0, 0.0, 0.0]
                    p[axis], p[a], p[b] = sign * half[axis], sa * half[a], sb * half[b]
                    p = [p[k] + radius * n[k] for k in range(3)]
                    p[2] += size[2] / 2
                    mesh.vertex(tuple(p), n, (p[a], p[b]))
            width = len(line)
            for j in range(width - 1):
                for i in range(width - 1):
                    q = first + j * width + i
                    corners = (q, q + 1, q + width + 1, q + width)
                    mesh.quad(*(corners if sign > 0 else corners[::-1]))
    return mesh
