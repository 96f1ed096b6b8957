# SPDX-License-Identifier: AGPL-3.0-or-later
"""Writes the files of the folder meshio by meshio 5: gmsh/body_22.msh in other formats.

Usage: make_meshio.py FOLDER
"""
import sys
from pathlib import Path

import meshio
import numpy

folder = Path(sys.argv[1])
mesh = meshio.read(folder / "gmsh" / "body_22.msh")
solid = meshio.Mesh(mesh.points, [c for c in mesh.cells if c.type == "tetra"])
regions = [d.astype(numpy.int32) for c, d in zip(mesh.cells, mesh.cell_data["gmsh:physical"]) if c.type == "tetra"]
solid.cell_data["material"] = regions
out = folder / "meshio"
meshio.write(out / "body.vtu", solid)  # base64, zlib
meshio.write(out / "body.vtk", solid)  # 5.1, binary
solid.cell_data = {}
solid.cell_sets = {name: [numpy.flatnonzero(r == tag) for r in regions]
                   for name, tag in (("left", 11), ("right", 12), ("nodule", 13))}
solid.point_sets = {"base": numpy.flatnonzero(mesh.points[:, 2] == 0)}
meshio.write(out / "body.inp", solid)
meshio.write(out / "body.msh", meshio.Mesh(mesh.points, solid.cells), file_format="gmsh22")
for name, tag in (("left", 11), ("right", 12), ("nodule", 13)):
    print(name, sum((r == tag).sum() for r in regions))
print("base", len(solid.point_sets["base"]))
