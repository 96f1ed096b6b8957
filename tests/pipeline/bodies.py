# SPDX-License-Identifier: AGPL-3.0-or-later
"""Small closed surfaces for the pipeline tests, made on the spot."""


def block(size, divisions):
    """A box from the origin: vertices (mm) and outward triangles, `divisions` cells an edge."""
    index, vertices, triangles = {}, [], []

    def vertex(i, j, k):
        key = (i, j, k)
        if key not in index:
            index[key] = len(vertices)
            vertices.append(tuple(size[a] * key[a] / divisions for a in range(3)))
        return index[key]

    def face(axis, side):
        u, v = [(1, 2), (2, 0), (0, 1)][axis]
        for p in range(divisions):
            for q in range(divisions):
                corner = []
                for dp, dq in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    at = [0, 0, 0]
                    at[axis], at[u], at[v] = side * divisions, p + dp, q + dq
                    corner.append(vertex(*at))
                if side == 0:
                    corner.reverse()
                triangles.append((corner[0], corner[1], corner[2]))
                triangles.append((corner[0], corner[2], corner[3]))

    for axis in range(3):
        for side in (0, 1):
            face(axis, side)
    return vertices, triangles


def write_off(path, surface):
    vertices, triangles = surface
    with open(path, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(vertices)} {len(triangles)} 0\n")
        for x, y, z in vertices:
            file.write(f"{x} {y} {z}\n")
        for a, b, c in triangles:
            file.write(f"3 {a} {b} {c}\n")


# A block in a tray: its base and sides are fixed, its top is touched, but not so near the rim that
# the tool would rest on it.
SIZE = (50, 50, 20)  # mm
CASE = """name = "block"

[surface]
file = "block.off"
unit = "mm"
region = "gel"

[mesh]
patch_spacing = "12.5 mm"
element_size = "4.2 mm"
interior_coarsening = 3.0

[[support]]
shape = "plane"
point = ["0 mm", "0 mm", "0.1 mm"]
normal = [0, 0, -1]

[[support]]
shape = "plane"
point = ["0.1 mm", "0 mm", "0 mm"]
normal = [-1, 0, 0]

[[support]]
shape = "plane"
point = ["49.9 mm", "0 mm", "0 mm"]
normal = [1, 0, 0]

[[support]]
shape = "plane"
point = ["0 mm", "0.1 mm", "0 mm"]
normal = [0, -1, 0]

[[support]]
shape = "plane"
point = ["0 mm", "49.9 mm", "0 mm"]
normal = [0, 1, 0]

[[material]]
region = "gel"
young = "10 kPa"
poisson = 0.45

[tool]
radius = "6 mm"

[indentation]
depth = "1.2 mm"
increments = 4
lateral_depths = ["0.6 mm"]
lateral_travel = "0.6 mm"
lateral_increments = 2

[fit]
absolute_tolerance = "2 mN"

[certify]
friction = 0.3
devices = ["device.toml"]

[simulate]
press_depth = "1 mm"
press_speed = "40 mm/s"
slide_length = "20 mm"
slide_speed = "25 mm/s"
"""

DEVICE = """name = "bench"
damping = "0.5 N s/m"
coulomb_friction = "0.1 N"
delay = "0 s"
position_resolution = "1 um"
force_resolution = "1 mN"
source = "made up for a test"
"""


def write_case(folder, case=CASE, surface=None):
    """block.toml, block.off and device.toml in `folder`; the path of the case."""
    write_off(folder / "block.off", surface or block(SIZE, 5))
    (folder / "device.toml").write_text(DEVICE, encoding="utf-8")
    path = folder / "block.toml"
    path.write_text(case, encoding="utf-8")
    return path
