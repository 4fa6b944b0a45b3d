#!/usr/bin/env python3
"""Writes the assets that the scenes use and that a formula describes: knot.ply, wheel.ply and pinion.ply, marble.data in the seed's format,
and hard/torus.ply, hard/slivers.ply and hard/sky.exr.

Usage: scenes/make_assets.py [FOLDER]    (default: this script's folder)
"""
import math
import os
import struct
import sys


def trefoil(t):
    """A point of the trefoil knot, t in [0, 1)."""
    a = 2 * math.pi * t
    return ((2 + math.cos(3 * a)) * math.cos(2 * a), (2 + math.cos(3 * a)) * math.sin(2 * a), 1.2 * math.sin(3 * a))


def unit(v):
    n = math.sqrt(sum(c * c for c in v))
    return tuple(c / n for c in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def write_mesh(path, vertices, triangles):
    """Binary little-endian PLY of a closed mesh, turned to be counter-clockwise seen from outside."""
    volume = 0.0
    for a, b, c in triangles:
        n = cross(vertices[b], vertices[c])
        volume += sum(x * y for x, y in zip(vertices[a], n))
    if volume < 0:
        triangles = [(a, c, b) for a, b, c in triangles]
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\n"
              f"property float y\nproperty float z\nelement face {len(triangles)}\n"
              "property list uchar int vertex_indices\nend_header\n")
    with open(path, "wb") as f:
        f.write(header.encode())
        f.write(b"".join(struct.pack("<3f", *v) for v in vertices))
        f.write(b"".join(struct.pack("<B3i", 3, *t) for t in triangles))


def write_knot(path, along=168, around=20, thickness=0.52):
    """A closed tube around the knot: counter-clockwise seen from outside, binary little-endian PLY."""
    step = 1e-5
    vertices, triangles = [], []
    for i in range(along):
        t = i / along
        p, after, before = trefoil(t), trefoil(t + step), trefoil(t - step)
        tangent = unit(tuple(x - y for x, y in zip(after, before)))
        bend = unit(tuple(x + y - 2 * z for x, y, z in zip(after, before, p)))
        side = unit(cross(tangent, bend))
        up = cross(side, tangent)
        for j in range(around):
            b = 2 * math.pi * j / around
            vertices.append(tuple(p[k] + thickness * (math.cos(b) * up[k] + math.sin(b) * side[k]) for k in range(3)))
            here, right = i * around + j, i * around + (j + 1) % around
            over, corner = (here + around) % (along * around), (right + around) % (along * around)
            triangles += [(here, over, corner), (here, corner, right)]
    write_mesh(path, vertices, triangles)


def write_torus(path, around=24, across=12, radius=1.0, tube=0.45):
    """About the z axis; closed."""
    vertices, triangles = [], []
    for i in range(around):
        a = 2 * math.pi * i / around
        for j in range(across):
            b = 2 * math.pi * j / across
            r = radius + tube * math.cos(b)
            vertices.append((r * math.cos(a), r * math.sin(a), tube * math.sin(b)))
            here, right = i * across + j, i * across + (j + 1) % across
            over, corner = (here + across) % (around * across), (right + across) % (around * across)
            triangles += [(here, over, corner), (here, corner, right)]
    write_mesh(path, vertices, triangles)


def write_wheel(path, teeth, spokes, thickness=0.34):
    """A toothed wheel about the z axis, its rim and spokes; its pitch radius is teeth / 12, a tooth lies along x; closed."""
    pitch = teeth / 12
    rim, hole = [], []
    for i in range(teeth):
        for radius, offset in ((pitch - 0.17, -0.32), (pitch + 0.13, -0.15), (pitch + 0.13, 0.15), (pitch - 0.17, 0.32)):
            a = 2 * math.pi * (i + offset) / teeth
            rim.append((radius * math.cos(a), radius * math.sin(a)))
            hole.append(((pitch - 0.5) * math.cos(a), (pitch - 0.5) * math.sin(a)))
    n = len(rim)
    vertices = [(x, y, z) for z in (-thickness / 2, thickness / 2) for ring in (rim, hole) for x, y in ring]
    triangles = []
    for i in range(n):
        j = (i + 1) % n
        # rings: 0 rim below, n hole below, 2 n rim above, 3 n hole above
        for a, b in ((0, n), (n, 3 * n), (3 * n, 2 * n), (2 * n, 0)):
            triangles += [(a + i, b + i, b + j), (a + i, b + j, a + j)]
    for i in range(spokes):
        a = 2 * math.pi * (i + 0.5) / spokes
        first = len(vertices)
        for z in (-thickness / 4, thickness / 4):
            for along, across in ((0.1, -0.09), (pitch - 0.4, -0.07), (pitch - 0.4, 0.07), (0.1, 0.09)):
                vertices.append((along * math.cos(a) - across * math.sin(a), along * math.sin(a) + across * math.cos(a), z))
        for a, b, c, d in ((3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
            triangles += [(first + a, first + b, first + c), (first + a, first + c, first + d)]
    write_mesh(path, vertices, triangles)


def write_slivers(path, thin=2.0**-19):
    """The box [-1, 1]^3 cut along planes across its axes, whose strips are 2^20 times as long as wide; closed."""
    cuts = [-1, -0.5, -0.5 + thin, 0, thin, 0.5, 0.5 + thin, 1]
    numbers, vertices, triangles = {}, [], []

    def number(point):
        if point not in numbers:
            numbers[point] = len(vertices)
            vertices.append(point)
        return numbers[point]

    for axis in range(3):
        for side in (-1, 1):
            for low, high in zip(cuts, cuts[1:]):
                for left, right in zip(cuts, cuts[1:]):
                    corners = []
                    for u, v in ((low, left), (high, left), (high, right), (low, right)):
                        point = [0, 0, 0]
                        point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = side, u, v
                        corners.append(number(tuple(point)))
                    triangles += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
                    if side < 0:
                        triangles[-2:] = [t[::-1] for t in triangles[-2:]]
    write_mesh(path, vertices, triangles)


def write_marble(path, size=224):
    """Dark and light marble in a herringbone of octagons: veins by folded sines, so that it repeats."""
    rows = bytearray()
    for y in range(size):
        for x in range(size):
            u, v = x / size, y / size
            a, b = 2 * math.pi * u, 2 * math.pi * v
            warp = math.sin(2 * a + 1.3 * math.sin(3 * b)) + 0.6 * math.sin(5 * b + 1.7 * math.sin(4 * a + b))
            vein = abs(math.sin(3 * a + 2 * b + 1.6 * warp)) ** 0.35
            cu, cv = abs((2 * u) % 1 - 0.5), abs((2 * v) % 1 - 0.5)
            octagon = max(cu, cv, (cu + cv) * 0.72)
            joint = 0.25 if abs(octagon - 0.43) < 0.012 else 1.0
            base = (238, 229, 214) if octagon < 0.43 else (92, 70, 66)
            shade = joint * (0.72 + 0.28 * vein)
            rows += bytes(min(255, int(c * shade)) for c in base) + b"\xff"
    with open(path, "wb") as f:
        f.write(struct.pack("<2i", size, size) + rows)


def write_sky(path, width=64, height=32):
    """A picture of all directions by longitude and latitude: blue above, a sun of radiance 40, hills, a dark plain; EXR."""
    rows = bytearray()
    for y in range(height):
        latitude = math.pi * (0.5 - (y + 0.5) / height)
        columns = []
        for x in range(width):
            longitude = 2 * math.pi * (0.5 - (x + 0.5) / width)
            hills = 0.12 + 0.06 * math.sin(3 * longitude) + 0.04 * math.sin(7 * longitude + 1)
            up = max(math.sin(latitude), 0.0)
            color = (0.75 - 0.55 * up, 0.85 - 0.5 * up, 1.0 - 0.25 * up)
            if latitude < hills:
                color = (0.12, 0.2, 0.1) if latitude > 0 else (0.2, 0.17, 0.14)
            if math.hypot(longitude - 0.9, latitude - 0.75) < 0.1:
                color = (40.0, 36.0, 28.0)
            columns.append(color)
        halves = b"".join(struct.pack("<e", color[c]) for c in (2, 1, 0) for color in columns)  # B, G, R
        rows += struct.pack("<2i", y, len(halves)) + halves

    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(c + b"\0" + struct.pack("<iB3x2i", 1, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<2i", 20000630, 2) + attribute("channels", "chlist", channels)
    header += attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", window)
    header += attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    size = len(rows) // height
    offsets = struct.pack("<%dQ" % height, *(len(header) + 8 * height + size * y for y in range(height)))
    with open(path, "wb") as f:
        f.write(header + offsets + rows)


if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    write_knot(os.path.join(folder, "knot.ply"))
    write_wheel(os.path.join(folder, "wheel.ply"), 24, 6)
    write_wheel(os.path.join(folder, "pinion.ply"), 12, 3)
    os.makedirs(os.path.join(folder, "hard"), exist_ok=True)
    write_torus(os.path.join(folder, "hard", "torus.ply"))
    write_slivers(os.path.join(folder, "hard", "slivers.ply"))
    write_sky(os.path.join(folder, "hard", "sky.exr"))
    write_marble(os.path.join(folder, "marble.data"))
