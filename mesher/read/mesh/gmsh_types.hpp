// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace palpate::mesher {

/// A kind of element of Gmsh.
struct GmshType {
  std::int64_t number;
  int dimension;
  std::size_t nodes;
  const char* name;  ///< plural
};

/// Elements up to the second order, and simplices of higher order that must be named in a refusal
/// [Gmsh 4.8 reference manual, section 9.1].
inline constexpr std::array kGmshTypes{GmshType{1, 1, 2, "lines"},
                                       GmshType{2, 2, 3, "triangles"},
                                       GmshType{3, 2, 4, "quadrangles"},
                                       GmshType{4, 3, 4, "tetrahedra"},
                                       GmshType{5, 3, 8, "hexahedra"},
                                       GmshType{6, 3, 6, "prisms"},
                                       GmshType{7, 3, 5, "pyramids"},
                                       GmshType{8, 1, 3, "lines"},
                                       GmshType{9, 2, 6, "triangles"},
                                       GmshType{10, 2, 9, "quadrangles"},
                                       GmshType{11, 3, 10, "tetrahedra"},
                                       GmshType{12, 3, 27, "hexahedra"},
                                       GmshType{13, 3, 18, "prisms"},
                                       GmshType{14, 3, 14, "pyramids"},
                                       GmshType{15, 0, 1, "points"},
                                       GmshType{16, 2, 8, "quadrangles"},
                                       GmshType{17, 3, 20, "hexahedra"},
                                       GmshType{18, 3, 15, "prisms"},
                                       GmshType{19, 3, 13, "pyramids"},
                                       GmshType{21, 2, 10, "triangles"},
                                       GmshType{23, 2, 15, "triangles"},
                                       GmshType{26, 1, 4, "lines"},
                                       GmshType{27, 1, 5, "lines"},
                                       GmshType{29, 3, 20, "tetrahedra of order 3"},
                                       GmshType{30, 3, 35, "tetrahedra of order 4"}};

inline constexpr std::int64_t kGmshTetrahedron = 4;
inline constexpr std::int64_t kGmshQuadraticTetrahedron = 11;

}  // namespace palpate::mesher
