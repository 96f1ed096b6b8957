// SPDX-License-Identifier: AGPL-3.0-or-later
// Where the skin of the body lies beside the flat triangles that carry the responses.
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

  /// How far the skin is from a point of the response surface along the unit vector `inward`, m:
  /// positive where the skin lies below, negative where it bulges out. Of several crossings the
  /// nearest. @throws Error(Geometry) where there is none.
  double beside(const Vec3& position, const Vec3& inward) const;

 private:
  /// Corners, then bulges of the edges 01, 12, 20 over the straight ones.
  struct Facet {
    std::array<Vec3, 3> corner{}, bulge{};
    bool curved = false;
  };
  static double entry(const Facet& facet, const Vec3& position, const Vec3& inward);

  std::string owner_;
  std::vector<Facet> facets_;
};

/// Sets HoldOutPoint::skin of the points that are at no node. @return how far the skin is from
/// them, m, ascending. @throws as Skin::beside.
std::vector<double> find_skin(const Body& body, std::vector<HoldOutPoint>& points);

}  // namespace palpate::fidelity
