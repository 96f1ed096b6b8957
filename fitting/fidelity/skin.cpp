// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fidelity/skin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "format/edge.hpp"
#include "format/error.hpp"

namespace palpate::fidelity {
namespace {

/// Tolerance at edges, so that no line passes between two facets.
constexpr double kRounding = 1e-9;
/// Each step multiplies the error by about the slope of the bulge, a tenth.
constexpr int kSteps = 12;

/// Where a line meets the plane of a triangle.
struct Crossing {
  double s;  ///< along the line
  Vec3 L;    ///< volume coordinates
};

/// None where the line leaves the body or runs along the triangle.
std::optional<Crossing> crossing(const std::array<Vec3, 3>& x, const Vec3& position,
                                 const Vec3& inward) {
  const Vec3 outward = cross(x[1] - x[0], x[2] - x[0]);  // twice the area long
  const double along = dot(outward, inward);
  if (!(along < 0)) return std::nullopt;
  const double s = dot(outward, x[0] - position) / along;
  const Vec3 at = position + s * inward;
  const double square = dot(outward, outward);
  const double L2 = dot(cross(x[1] - x[0], at - x[0]), outward) / square;
  const double L0 = dot(cross(x[2] - x[1], at - x[1]), outward) / square;
  return Crossing{s, {L0, 1 - L0 - L2, L2}};
}

}  // namespace

Skin::Skin(const Body& body) : owner_("body '" + body.name + "'") {
  std::map<Edge, Vec3> middle;
  for (const CurvedEdge& edge : body.curved_edges) middle.emplace(edge.ends, edge.middle);
  for (const Triangle& nodes : body.boundary) {
    Facet facet;
    for (std::size_t i = 0; i < 3; ++i)
      facet.corner[i] = body.nodes[static_cast<std::size_t>(nodes[i])];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto found = middle.find(edge_between(nodes[i], nodes[(i + 1) % 3]));
      if (found == middle.end()) continue;
      facet.bulge[i] = found->second - 0.5 * (facet.corner[i] + facet.corner[(i + 1) % 3]);
      facet.curved = true;
    }
    facets_.push_back(facet);
  }
}

/// The s at which the line position + s inward enters the body through a facet; NaN where it does
/// not. A curved facet is sum_i L_i x_i + sum_ij 4 L_i L_j b_ij with the edge offsets b. The fixed
/// point iteration intersects the flat facet with the line shifted back by the second sum.
double Skin::entry(const Facet& facet, const Vec3& position, const Vec3& inward) {
  std::optional<Crossing> at = crossing(facet.corner, position, inward);
  const auto inside = [&] {
    return std::ranges::all_of(at->L, [](double L) { return L >= -kRounding; });
  };
  if (!at || !inside()) return std::numeric_limits<double>::quiet_NaN();
  for (int step = 0; facet.curved && step < kSteps; ++step) {
    Vec3 bulge{};
    for (std::size_t i = 0; i < 3; ++i)
      bulge = bulge + (4 * at->L[i] * at->L[(i + 1) % 3]) * facet.bulge[i];
    at = crossing(facet.corner, position - bulge, inward);
  }
  return at->s;
}

double Skin::distance(const Vec3& position, const Vec3& inward) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Facet& facet : facets_) {
    const double s = entry(facet, position, inward);
    if (std::abs(s) < std::abs(nearest)) nearest = s;
  }
  if (std::isinf(nearest)) {
    throw Error(ErrorKind::Geometry, owner_,
                "no skin is found along the press direction of a point of the response surface",
                "mesh the body again: its response surface does not belong to its boundary");
  }
  return nearest;
}

std::vector<double> find_skin(const Body& body, std::vector<HoldOutPoint>& points) {
  const Skin skin(body);
  std::vector<double> distances;
  for (HoldOutPoint& point : points) {
    if (point.node) continue;
    point.skin = skin.distance(point.position, point.inward);
    distances.push_back(std::abs(point.skin));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

}  // namespace palpate::fidelity
