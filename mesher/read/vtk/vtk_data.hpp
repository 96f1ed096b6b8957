// SPDX-License-Identifier: AGPL-3.0-or-later
// A data set of VTK, whichever of its formats it was read from.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "format/vec3.hpp"
#include "mesher/geometry/soup.hpp"
#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// One value or vector for each point or cell.
struct VtkArray {
  std::string name;
  std::size_t components = 1;
  bool is_integral = false;
  std::vector<double> values;
};

/// An array whose type is one of integers holds integers, unless a text has others in it.
VtkArray vtk_array(std::string name, std::size_t components, bool is_integral,
                   std::vector<double> values);

struct VtkData {
  std::vector<Vec3> points;
  std::vector<int> types;                  ///< of each cell, by the numbers of VTK
  std::vector<std::int64_t> offsets;       ///< into connectivity, behind the points of each cell
  std::vector<std::int64_t> connectivity;  ///< indices into points, checked
  std::vector<VtkArray> point_arrays, cell_arrays;
  std::map<std::string, std::vector<std::string>> texts;  ///< arrays of strings of the whole set

  std::size_t begin_of(std::size_t cell) const {
    return cell == 0 ? 0 : static_cast<std::size_t>(offsets[cell - 1]);
  }
  std::size_t end_of(std::size_t cell) const { return static_cast<std::size_t>(offsets[cell]); }
};

/// Cell types that palpate handles [VTK file formats, figure 2].
enum VtkCell : int {
  VtkVertex = 1,
  VtkPolyVertex = 2,
  VtkLine = 3,
  VtkPolyLine = 4,
  VtkTriangle = 5,
  VtkStrip = 6,
  VtkPolygon = 7,
  VtkPixel = 8,
  VtkQuad = 9,
  VtkTetrahedron = 10,
  VtkQuadraticEdge = 21,
  VtkQuadraticTriangle = 22,
  VtkQuadraticQuad = 23,
  VtkQuadraticTetrahedron = 24
};

/// @throws Error(Geometry) where offsets do not ascend to the size of the connectivity, an index is
///   no point, or a cell has another number of points than its type.
void check_cells(const VtkData& data, const std::string& where);

/// The tetrahedra, their regions, and sets of nodes.
/// Regions are the values of an integer cell array: `region_array`, or, where that is empty, the
/// only integer cell array there is, or the one that is called region, material, gmsh:physical or
/// the like. The region of value 3 is "region=3", unless the data set has an array of strings
/// "region_names", whose row 3 is its name. Arrays of integers with few values give sets of the
/// same names; those of only 0 and 1 give one set, named after the array.
/// @throws Error(Geometry) where there is no such array or several could be meant.
MeshEntities volume_entities(const VtkData& data, const std::string& region_array,
                             const std::string& where);

/// The polygons, triangle strips divided. Their names are those of the values of integer cell
/// arrays, "Name=3".
/// @throws Error(Geometry) where there are volume cells.
Soup surface_of(const VtkData& data, const std::string& where);

}  // namespace palpate::mesher
