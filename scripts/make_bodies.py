#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Make the surfaces in data/bodies: cylinder.off, organ.off, nodule.off, liver-nodule.off, pad.off,
slice.off, meat.off (millimetres).

Only the Python standard library; the same files come out on every machine up to the last printed
digit. Run from anywhere: scripts/make_bodies.py [folder]
"""

import math
import pathlib
import sys


# Centre of the nodule in data/bodies/sofa/liver.obj, mm: 16 mm below the anterior surface of the
# right lobe, along the normal at (-75, -96.1, 1520) mm.
LIVER_NODULE = (-70.6, -81.3, 1515.9)


def write_off(path, comment, points, triangles, digits=3):
    with open(path, "w", encoding="ascii", newline="\n") as out:
        out.write(f"OFF\n# {comment}\n{len(points)} {len(triangles)} 0\n")
        for point in points:
            out.write(" ".join(f"{x:.{digits}f}" for x in point) + "\n")
        for triangle in triangles:
            out.write("3 %d %d %d\n" % triangle)


def cylinder(radius, length, around, along, rings):
    """Solid cylinder about z from z = 0, closed by flat caps; outward triangles."""
    points = []
    triangles = []

    def circle(r, z):
        first = len(points)
        for k in range(around):
            angle = 2 * math.pi * k / around
            points.append((r * math.cos(angle), r * math.sin(angle), z))
        return first

    def band(lower, upper):
        """Quads between two circles, outward when `upper` follows on an outward turn."""
        for k in range(around):
            a, b = lower + k, lower + (k + 1) % around
            c, d = upper + (k + 1) % around, upper + k
            # Diagonals alternate so that the triangulation leans to neither side.
            if k % 2:
                triangles.extend([(a, b, c), (a, c, d)])
            else:
                triangles.extend([(a, b, d), (b, c, d)])

    levels = [circle(radius, length * k / along) for k in range(along + 1)]
    for lower, upper in zip(levels, levels[1:]):
        band(lower, upper)

    def cap(rim, z, is_top):
        outer = rim
        for ring in range(rings - 1, 0, -1):
            inner = circle(radius * ring / rings, z)
            if is_top:
                band(outer, inner)
            else:
                band(inner, outer)
            outer = inner
        centre = len(points)
        points.append((0.0, 0.0, z))
        for k in range(around):
            a, b = outer + k, outer + (k + 1) % around
            triangles.append((a, b, centre) if is_top else (b, a, centre))

    cap(levels[0], 0.0, is_top=False)
    cap(levels[-1], length, is_top=True)
    return points, triangles


def geodesic_sphere(frequency):
    """Unit icosphere whose edges are divided into `frequency` parts; outward triangles."""
    phi = (1 + math.sqrt(5)) / 2
    corners = [(-1, phi, 0), (1, phi, 0), (-1, -phi, 0), (1, -phi, 0), (0, -1, phi), (0, 1, phi),
               (0, -1, -phi), (0, 1, -phi), (phi, 0, -1), (phi, 0, 1), (-phi, 0, -1), (-phi, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
             (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
             (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    points, number, triangles = [], {}, []

    def vertex(weights):
        """Weights of the corners name a vertex uniquely, whichever face asks for it."""
        key = tuple(sorted((c, w) for c, w in weights if w))
        if key not in number:
            x = [sum(w * corners[c][k] for c, w in key) for k in range(3)]
            size = math.sqrt(sum(v * v for v in x))
            number[key] = len(points)
            points.append(tuple(v / size for v in x))
        return number[key]

    for a, b, c in faces:
        def at(i, j, face=(a, b, c)):
            return vertex([(face[0], frequency - i - j), (face[1], i), (face[2], j)])
        for i in range(frequency):
            for j in range(frequency - i):
                triangles.append((at(i, j), at(i + 1, j), at(i, j + 1)))
                if i + j < frequency - 1:
                    triangles.append((at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
    return points, triangles


def smooth_max(a, b, width):
    """max(a, b) rounded over `width`, with continuous slopes."""
    h = max(width - abs(a - b), 0.0) / width
    return max(a, b) + h * h * width / 4


def ellipsoid(x, centre, radii):
    """About the distance in mm from an ellipsoid, negative inside."""
    scaled = [(x[k] - centre[k]) / radii[k] for k in range(3)]
    size = math.sqrt(sum(v * v for v in scaled))
    return (size - 1) * min(radii)


def organ_field(x):
    """Negative inside an organ of two lobes with a flat underside, about mm near its surface."""
    right = ellipsoid(x, (-26, 4, 2), (62, 58, 42))
    left = ellipsoid(x, (50, -10, -4), (50, 38, 29))
    tip = ellipsoid(x, (-38, -34, -6), (40, 34, 26))
    lobes = -smooth_max(-right, -left, 14)
    lobes = -smooth_max(-lobes, -tip, 16)
    # The groove between the lobes runs over the top and the front edge.
    groove = -math.hypot(x[0] - 17 - 0.12 * x[1], 0.75 * (x[2] - 41)) + 13
    lobes = smooth_max(lobes, groove, 16)
    ripple = 1.2 * math.sin(x[0] / 17 + 0.6) * math.sin(x[1] / 15 - 0.4) * math.sin(x[2] / 19 + 1)
    underside = -26 - x[2]
    return smooth_max(lobes + ripple, underside, 9)


def on_organ(direction):
    """The point of the organ's surface seen from its middle; the organ is star-shaped about it."""
    middle = (6, -4, -6)

    def at(s):
        return tuple(middle[k] + s * direction[k] for k in range(3))

    low, high = 0.0, 2.0
    # March outward to the first sign change, then bisect.
    step = 0.02
    while organ_field(at(low + step)) < 0:
        low += step
    high = low + step
    for _ in range(50):
        mid = (low + high) / 2
        if organ_field(at(mid)) < 0:
            low = mid
        else:
            high = mid
    return at(low)


def organ(frequency):
    sphere, triangles = geodesic_sphere(frequency)
    stretch = (100, 62, 38)
    return [on_organ(tuple(stretch[k] * p[k] for k in range(3))) for p in sphere], triangles


def outward_normal(x, h=1e-4):
    gradient = []
    for k in range(3):
        high = [x[i] + (h if i == k else 0) for i in range(3)]
        low = [x[i] - (h if i == k else 0) for i in range(3)]
        gradient.append(organ_field(high) - organ_field(low))
    size = math.sqrt(sum(g * g for g in gradient))
    return [g / size for g in gradient]


def ball(centre, radius, frequency):
    sphere, triangles = geodesic_sphere(frequency)
    return [tuple(centre[k] + radius * p[k] for k in range(3)) for p in sphere], triangles


def nodule(radius, cover, frequency):
    """Sphere whose top lies `cover` below the upper surface of the right lobe."""
    top = on_organ((-36, 16, 48))
    normal = outward_normal(top)
    centre = [top[k] - (cover + radius) * normal[k] for k in range(3)]
    return *ball(centre, radius, frequency), top


def box(size, divisions):
    """Box with a corner at the origin; outward triangles, `divisions` cells an edge."""
    index, points, triangles = {}, [], []

    def vertex(key):
        if key not in index:
            index[key] = len(points)
            points.append(tuple(size[a] * key[a] / divisions for a in range(3)))
        return index[key]

    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            for p in range(divisions):
                for q in range(divisions):
                    corner = []
                    for dp, dq in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        at = [0, 0, 0]
                        at[axis], at[u], at[v] = side * divisions, p + dp, q + dq
                        corner.append(vertex(tuple(at)))
                    if side == 0:
                        corner.reverse()
                    triangles.append((corner[0], corner[1], corner[2]))
                    triangles.append((corner[0], corner[2], corner[3]))
    return points, triangles


def main():
    home = pathlib.Path(__file__).resolve().parent.parent / "data" / "bodies"
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else home
    folder.mkdir(parents=True, exist_ok=True)
    note = "Made by scripts/make_bodies.py of palpate. Unit: millimetre. CC0-1.0."

    points, triangles = cylinder(radius=40, length=74, around=128, along=18, rings=5)
    write_off(folder / "cylinder.off", note, points, triangles, digits=4)
    points, triangles = organ(frequency=24)
    write_off(folder / "organ.off", note, points, triangles)
    points, triangles, top = nodule(radius=11, cover=6, frequency=8)
    write_off(folder / "nodule.off", note, points, triangles, digits=4)
    points, triangles = ball(LIVER_NODULE, radius=12, frequency=8)
    write_off(folder / "liver-nodule.off", note, points, triangles, digits=4)
    points, triangles = box(size=(50, 50, 20), divisions=5)
    write_off(folder / "pad.off", note, points, triangles, digits=1)
    points, triangles = box(size=(4, 4, 1), divisions=1)
    write_off(folder / "slice.off", note, points, triangles, digits=1)
    points, triangles = box(size=(50, 50, 9.7), divisions=5)
    write_off(folder / "meat.off", note, points, triangles, digits=2)
    print("nodule lies under", ", ".join(f"{x:.1f}" for x in top), "mm")


if __name__ == "__main__":
    main()
