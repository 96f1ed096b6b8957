# SPDX-License-Identifier: AGPL-3.0-or-later
"""Writes the files of the folder vtk by VTK 9.1: body.vtu in every encoding, from gmsh/body.vtk.

Usage: make_vtk.py FOLDER
"""
import sys
from pathlib import Path

import vtk
from vtk.util.numpy_support import vtk_to_numpy

folder = Path(sys.argv[1])
reader = vtk.vtkUnstructuredGridReader()
reader.SetFileName(str(folder / "gmsh" / "body.vtk"))
reader.Update()
whole = reader.GetOutput()

# The tetrahedra and the triangles, with regions by the parts of the box.
grid = vtk.vtkUnstructuredGrid()
grid.SetPoints(whole.GetPoints())
regions = vtk.vtkIntArray()
regions.SetName("region")
for i in range(whole.GetNumberOfCells()):
    cell = whole.GetCell(i)
    if cell.GetCellType() not in (vtk.VTK_TETRA, vtk.VTK_TRIANGLE):
        continue
    grid.InsertNextCell(cell.GetCellType(), cell.GetPointIds())
    middle = [sum(cell.GetPoints().GetPoint(k)[a] for k in range(cell.GetNumberOfPoints()))
              / cell.GetNumberOfPoints() for a in range(3)]
    near = sum((x - c) ** 2 for x, c in zip(middle, (10, 15, 12))) ** 0.5
    if cell.GetCellType() == vtk.VTK_TRIANGLE:
        regions.InsertNextValue(9)
    else:
        regions.InsertNextValue(3 if near < 5.5 else 1 if middle[0] < 20 else 2)
grid.GetCellData().AddArray(regions)
heights = vtk.vtkDoubleArray()
heights.SetName("height")
marks = vtk.vtkUnsignedCharArray()
marks.SetName("top")
for i in range(grid.GetNumberOfPoints()):
    heights.InsertNextValue(grid.GetPoint(i)[2])
    marks.InsertNextValue(1 if grid.GetPoint(i)[2] > 19.999 else 0)
grid.GetPointData().AddArray(heights)
grid.GetPointData().AddArray(marks)

sizes = vtk.vtkCellSizeFilter()
sizes.SetInputData(grid)
sizes.Update()
volumes = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
numbers = vtk_to_numpy(regions)
for region in (1, 2, 3):
    print(f"region {region}: {(numbers == region).sum()} tetrahedra, "
          f"{volumes[numbers == region].sum():.6f} mm^3")
print(f"top: {vtk_to_numpy(marks).sum()} nodes; region 9: {(numbers == 9).sum()} triangles")


def write_xml(name, data, kind=vtk.vtkXMLUnstructuredGridWriter):
    for mode in ("ascii", "binary", "appended"):
        for compress in ("", "_zlib"):
            if mode == "ascii" and compress:
                continue
            writer = kind()
            writer.SetFileName(str(folder / "vtk" / f"{name}_{mode}{compress}.{writer.GetDefaultFileExtension()}"))
            writer.SetInputData(data)
            getattr(writer, {"ascii": "SetDataModeToAscii", "binary": "SetDataModeToBinary",
                             "appended": "SetDataModeToAppended"}[mode])()
            if compress:
                writer.SetCompressorTypeToZLib()
                writer.SetBlockSize(1024)
            else:
                writer.SetCompressorTypeToNone()
            if mode == "appended":
                writer.EncodeAppendedDataOff() if compress else writer.EncodeAppendedDataOn()
            if mode == "binary" and compress:
                writer.SetHeaderTypeToUInt32()
            else:
                writer.SetHeaderTypeToUInt64()
            if mode == "appended" and compress:
                writer.SetByteOrderToBigEndian()
            writer.Write()


write_xml("body", grid)
raw = vtk.vtkXMLUnstructuredGridWriter()
raw.SetFileName(str(folder / "vtk" / "body_raw.vtu"))
raw.SetInputData(grid)
raw.SetDataModeToAppended()
raw.EncodeAppendedDataOff()
raw.SetCompressorTypeToNone()
raw.Write()

for version, suffix in ((42, "4"), (51, "5")):
    for binary in (False, True):
        writer = vtk.vtkUnstructuredGridWriter()
        writer.SetFileVersion(version)
        writer.SetFileName(str(folder / "vtk" / f"body_{suffix}{'_binary' if binary else ''}.vtk"))
        writer.SetInputData(grid)
        writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
        writer.Write()

# A surface with a strip, faces of four corners and an array on them.
box = vtk.vtkCubeSource()
box.SetXLength(40)
box.SetYLength(30)
box.SetZLength(20)
box.Update()
surface = vtk.vtkPolyData()
surface.SetPoints(box.GetOutput().GetPoints())
surface.SetPolys(box.GetOutput().GetPolys())
sides = vtk.vtkIntArray()
sides.SetName("side")
for i in range(6):
    sides.InsertNextValue(i)
surface.GetCellData().AddArray(sides)
write_xml("box", surface, vtk.vtkXMLPolyDataWriter)
for binary in (False, True):
    writer = vtk.vtkPolyDataWriter()
    writer.SetFileVersion(51 if binary else 42)
    writer.SetFileName(str(folder / "vtk" / f"box{'_5_binary' if binary else '_4'}.vtk"))
    writer.SetInputData(surface)
    writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
    writer.Write()
stripper = vtk.vtkStripper()
triangles = vtk.vtkTriangleFilter()
triangles.SetInputData(surface)
stripper.SetInputConnection(triangles.GetOutputPort())
stripper.Update()
writer = vtk.vtkXMLPolyDataWriter()
writer.SetFileName(str(folder / "vtk" / "box_strips.vtp"))
writer.SetInputData(stripper.GetOutput())
writer.SetDataModeToAscii()
writer.Write()
