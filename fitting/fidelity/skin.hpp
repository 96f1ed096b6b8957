// SPDX-License-Identifier: AGPL-3.0-or-later
// The skin: the boundary of the body, which is curved, relative to the flat response triangles.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fitting/fidelity/hold_out.hpp"
#include "format/body.hpp"

namespace palpate::fidelity {

/// The skin of a body: its boundary facets, curved where their edges are (CurvedEdge). Immutable.
class Skin {
 public:
  explicit Skin(const Body& body);

  /// Distance from a point of the response surface to the skin along the unit vector `inward`, m:
  /// positive where the skin lies below, negative where it bulges out. The nearest of several
  /// crossings. @throws Error(Geometry) where there is none.
  double distance(const Vec3& position, const Vec3& inward) const;

 private:
  /// Corners, and offsets of the middles of the curved edges 01, 12, 20 from the straight ones.
  struct Facet {
    std::array<Vec3, 3> corner{}, bulge{};
    bool curved = false;
  };
  static double entry(const Facet& facet, const Vec3& position, const Vec3& inward);

  std::string owner_;
  std::vector<Facet> facets_;
};

/// Sets HoldOutPoint::skin of the points off the nodes. @return their distances, m, ascending.
/// @throws as Skin::distance.
std::vector<double> find_skin(const Body& body, std::vector<HoldOutPoint>& points);

}  // namespace palpate::fidelity
