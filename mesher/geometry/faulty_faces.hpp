// SPDX-License-Identifier: AGPL-3.0-or-later
// The faces for which a surface is refused, so that a user can look at them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "format/error.hpp"
#include "format/vec3.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// What is wrong with a face; the values are those of the cell array "fault" in the file.
enum class Fault : std::int32_t {
  BorderEdge = 1,       ///< at a hole, or of an open sheet
  NonManifoldEdge = 2,  ///< at an edge with more than two faces
  ZeroArea = 3,
  SelfIntersection = 4,  ///< crosses another face
  SeparatePart = 5,      ///< of a part that is not connected with the largest one
  Moved = 6,             ///< farther from the repaired surface than allowed
  NonManifoldPoint = 7   ///< at a point in which sheets meet
};

struct FaultyFaces {
  std::vector<Vec3> points;  ///< m, three of each face
  std::vector<Fault> faults;

  void add(const Vec3& a, const Vec3& b, const Vec3& c, Fault fault);
  void add(const Surface& surface, const Triangle& triangle, Fault fault);
  /// The triangles of the polygon, as a fan.
  void add(const std::vector<Vec3>& points, const std::vector<std::size_t>& corners, Fault fault);
};

/// An Error(Geometry) with the faces that are at fault.
class FaultySurface : public Error {
 public:
  FaultySurface(std::string where, std::string problem, std::string remedy, FaultyFaces faces);
  const FaultyFaces& faces() const noexcept { return faces_; }

 private:
  FaultyFaces faces_;
};

/// Text of a VTK PolyData file (.vtp): the triangles, coordinates in m, and the cell array "fault".
std::string vtp_text(const FaultyFaces& faces);

}  // namespace palpate::mesher
