// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/curved_skin.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "format/edge.hpp"
#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

constexpr double kLeastVolume = 1.0 / 3;  ///< of the volume of a part under straight edges
constexpr int kMostHalvings = 6;          ///< after them an edge is straight

/// Nodes of an element: corners 0..3, then the middles of these edges.
constexpr std::array<std::array<std::size_t, 2>, 6> kEdges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// A part of an element: a tetrahedron of four of its nodes.
using Part = std::array<std::size_t, 4>;
using Nodes = std::array<Vec3, 10>;

double six_volumes(const Nodes& x, const Part& part) {
  return dot(cross(x[part[1]] - x[part[0]], x[part[2]] - x[part[0]]), x[part[3]] - x[part[0]]);
}

/// Every four nodes that do not lie in one plane when the edges are straight. They include all
/// parts that a division of the element can make.
std::vector<Part> parts_with_volume() {
  Nodes unit{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  for (std::size_t e = 0; e < 6; ++e) unit[4 + e] = 0.5 * (unit[kEdges[e][0]] + unit[kEdges[e][1]]);
  std::vector<Part> parts;
  for (std::size_t a = 0; a < 10; ++a)
    for (std::size_t b = a + 1; b < 10; ++b)
      for (std::size_t c = b + 1; c < 10; ++c)
        for (std::size_t d = c + 1; d < 10; ++d) {
          const double volume = six_volumes(unit, {a, b, c, d});
          if (volume > 1e-12) parts.push_back({a, b, c, d});
          if (volume < -1e-12) parts.push_back({a, b, d, c});
        }
  return parts;
}

/// The bulges of the curved edges while they are reduced.
class Bulges {
 public:
  explicit Bulges(Body& body) : body_(body), halvings_(body.curved_edges.size(), 0) {
    for (std::size_t e = 0; e < body.curved_edges.size(); ++e) {
      const CurvedEdge& edge = body.curved_edges[e];
      index_.emplace(edge.ends, e);
      bulge_.push_back(edge.middle - straight(edge.ends));
    }
  }

  std::size_t reduce() {
    const std::vector<std::size_t> touched = curved_elements();
    for (bool changed = true; changed;) {
      changed = false;
      for (const std::size_t element : touched)
        if (!has_valid_parts(element) && halve_around(element)) changed = true;
    }
    return write_back();
  }

 private:
  Edge edge_of(std::size_t element, std::size_t e) const {
    const Tetrahedron& corners = body_.tetrahedra[element];
    return edge_between(corners[kEdges[e][0]], corners[kEdges[e][1]]);
  }

  Vec3 straight(const Edge& ends) const {
    return 0.5 * (body_.nodes[to_index(ends[0])] + body_.nodes[to_index(ends[1])]);
  }

  Vec3 bulge(std::size_t edge) const {
    if (halvings_[edge] >= kMostHalvings) return {};
    return (1.0 / (1 << halvings_[edge])) * bulge_[edge];
  }

  std::vector<std::size_t> curved_elements() const {
    std::vector<std::size_t> elements;
    for (std::size_t t = 0; t < body_.tetrahedra.size(); ++t)
      for (std::size_t e = 0; e < 6; ++e)
        if (index_.contains(edge_of(t, e))) {
          elements.push_back(t);
          break;
        }
    return elements;
  }

  bool has_valid_parts(std::size_t element) const {
    Nodes flat{}, curved{};
    for (std::size_t c = 0; c < 4; ++c)
      flat[c] = curved[c] = body_.nodes[to_index(body_.tetrahedra[element][c])];
    for (std::size_t e = 0; e < 6; ++e) {
      const Edge ends = edge_of(element, e);
      flat[4 + e] = curved[4 + e] = straight(ends);
      const auto found = index_.find(ends);
      if (found != index_.end()) curved[4 + e] = flat[4 + e] + bulge(found->second);
    }
    return std::all_of(parts_.begin(), parts_.end(), [&](const Part& part) {
      return six_volumes(curved, part) >= kLeastVolume * six_volumes(flat, part);
    });
  }

  /// @return false when all edges of the element are straight
  bool halve_around(std::size_t element) {
    bool halved = false;
    for (std::size_t e = 0; e < 6; ++e) {
      const auto found = index_.find(edge_of(element, e));
      if (found == index_.end() || halvings_[found->second] >= kMostHalvings) continue;
      ++halvings_[found->second];
      halved = true;
    }
    return halved;
  }

  /// Removes straight edges.
  std::size_t write_back() {
    std::vector<CurvedEdge> curved;
    for (std::size_t e = 0; e < halvings_.size(); ++e) {
      const Edge ends = body_.curved_edges[e].ends;
      if (halvings_[e] < kMostHalvings) curved.push_back({ends, straight(ends) + bulge(e)});
    }
    body_.curved_edges = std::move(curved);
    return halvings_.size() -
           static_cast<std::size_t>(std::count(halvings_.begin(), halvings_.end(), 0));
  }

  Body& body_;
  const std::vector<Part> parts_ = parts_with_volume();
  std::vector<int> halvings_;  ///< of each curved edge
  std::vector<Vec3> bulge_;    ///< of each, before reduction
  std::map<Edge, std::size_t> index_;
};

}  // namespace

std::size_t reduce_bulges(Body& body) {
  return Bulges(body).reduce();
}

}  // namespace palpate::mesher
