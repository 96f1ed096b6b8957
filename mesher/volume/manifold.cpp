// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/manifold.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/volume/boundary.hpp"
#include "mesher/volume/fans.hpp"

namespace palpate::mesher {
namespace {

/// A tip is filled up to this part of the shortest edge at it, and of the way across its void.
constexpr double kTip = 1.0 / 3;

/// Halvings of that height until nothing else of the boundary lies in the tip.
constexpr int kMostHeightHalvings = 6;

/// Where the middle of a void makes an angle with a facet whose sine is smaller, the tetrahedra in
/// the tip would be flat.
constexpr double kFlattest = 0.1;

bool has(const Tetrahedron& t, std::int32_t node) {
  return std::find(t.begin(), t.end(), node) != t.end();
}

std::vector<std::int32_t> nodes_of(const std::vector<Triangle>& facets) {
  std::vector<std::int32_t> nodes;
  for (const Triangle& t : facets) nodes.insert(nodes.end(), t.begin(), t.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

class Separation {
 public:
  Separation(std::vector<Vec3>& nodes, std::vector<Tetrahedron>& tetrahedra)
      : nodes_(nodes),
        tetrahedra_(tetrahedra),
        nodes_before_(nodes.size()),
        before_(tetrahedra.size()) {}

  ManifoldChange run() {
    copy_nodes();
    halve_edges(pinches(adjacency(tetrahedra_).boundary).edges);
    fill_tips();
    return std::move(change_);
  }

 private:
  void copy_nodes() {
    for (const std::int32_t v : split_nodes(tetrahedra_, nodes_.size())) {
      const Edge from =
          to_index(v) < nodes_before_ ? Edge{v, v} : change_.node_from[to_index(v) - nodes_before_];
      add_node(Vec3(nodes_[to_index(v)]), from);
      ++change_.copies;
    }
  }

  std::int32_t add_node(const Vec3& x, const Edge& from) {
    nodes_.push_back(x);
    change_.node_from.push_back(from);
    return static_cast<std::int32_t>(nodes_.size() - 1);
  }

  void add_tetrahedron(const Tetrahedron& corners, std::size_t from) {
    tetrahedra_.push_back(corners);
    change_.tetrahedron_from.push_back(from < before_ ? static_cast<std::int32_t>(from)
                                                      : change_.tetrahedron_from[from - before_]);
  }

  void halve_edges(const std::vector<Edge>& edges) {
    if (edges.empty()) return;
    std::map<Edge, std::vector<std::size_t>> around;
    for (const Edge& edge : edges) around[edge];
    const auto enter = [&](std::size_t t) {
      const Tetrahedron& corners = tetrahedra_[t];
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a + 1; b < 4; ++b)
          if (const auto entry = around.find(edge_between(corners[a], corners[b]));
              entry != around.end())
            entry->second.push_back(t);
    };
    for (std::size_t t = 0; t < before_; ++t) enter(t);
    for (const Edge& edge : edges) {
      const auto [p, q] = edge;
      const std::int32_t middle = add_node(0.5 * (nodes_[to_index(p)] + nodes_[to_index(q)]), edge);
      for (const std::size_t t : std::vector<std::size_t>(around[edge])) {
        if (!has(tetrahedra_[t], p) || !has(tetrahedra_[t], q)) continue;  // halved before
        Tetrahedron half = tetrahedra_[t];
        std::replace(half.begin(), half.end(), p, middle);
        std::replace(tetrahedra_[t].begin(), tetrahedra_[t].end(), q, middle);
        add_tetrahedron(half, t);
        enter(tetrahedra_.size() - 1);
      }
    }
    change_.halved_edges = edges.size();
    copy_nodes();
  }

  void fill_tips() {
    const std::vector<Triangle> boundary = adjacency(tetrahedra_).boundary;
    const std::vector<std::int32_t> meetings = pinches(boundary).nodes;
    if (!meetings.empty()) walls_ = nodes_of(boundary);
    for (const std::int32_t node : meetings) {
      std::vector<OpenFan> fans;
      for (std::vector<Triangle>& fan : fans_at(tetrahedra_, node))
        fans.push_back(open_fan(nodes_, std::move(fan)));
      std::stable_sort(fans.begin(), fans.end(), [](const OpenFan& a, const OpenFan& b) {
        return a.least_sine > b.least_sine;
      });
      for (std::size_t i = 0; i + 1 < fans.size(); ++i) fill_tip(node, fans[i], boundary);
    }
  }

  void fill_tip(std::int32_t node, const OpenFan& fan, const std::vector<Triangle>& boundary) {
    if (fan.least_sine < kFlattest) return;
    const std::optional<Vec3> tip = find_tip(node, fan, boundary);
    if (!tip) return;
    const std::int32_t added = add_node(*tip, {node, node});
    walls_.push_back(added);
    for (const Triangle& facet : fan.facets)
      add_tetrahedron({facet[0], facet[1], facet[2], added}, tetrahedron_at(facet));
    ++change_.filled_tips;
  }

  /// The tetrahedron with this facet of the boundary.
  std::size_t tetrahedron_at(const Triangle& facet) const {
    const auto found =
        std::find_if(tetrahedra_.begin(), tetrahedra_.end(), [&](const Tetrahedron& t) {
          return has(t, facet[0]) && has(t, facet[1]) && has(t, facet[2]);
        });
    return static_cast<std::size_t>(found - tetrahedra_.begin());
  }

  /// A point of the void before the node so that the tetrahedra between it and the facets have
  /// nothing else of the boundary in them.
  std::optional<Vec3> find_tip(std::int32_t node, const OpenFan& fan,
                               const std::vector<Triangle>& boundary) const {
    const Vec3& at = nodes_[to_index(node)];
    double room = way_across(nodes_, boundary, node, fan.direction);
    for (const Triangle& facet : fan.facets)
      for (const std::int32_t v : facet)
        if (v != node) room = std::min(room, norm(nodes_[to_index(v)] - at));
    double height = kTip * room;
    for (int halving = 0; halving < kMostHeightHalvings; ++halving, height /= 2) {
      const Vec3 tip = at + height * fan.direction;
      if (is_free(tip, fan)) return tip;
    }
    return std::nullopt;
  }

  bool is_free(const Vec3& tip, const OpenFan& fan) const {
    for (const Triangle& facet : fan.facets) {
      const std::array<Vec3, 4> corners{nodes_[to_index(facet[0])], nodes_[to_index(facet[1])],
                                        nodes_[to_index(facet[2])], tip};
      if (std::any_of(walls_.begin(), walls_.end(),
                      [&](std::int32_t v) { return is_inside(corners, nodes_[to_index(v)]); }))
        return false;
    }
    return true;
  }

  std::vector<Vec3>& nodes_;
  std::vector<Tetrahedron>& tetrahedra_;
  std::size_t nodes_before_, before_;  // of nodes and of tetrahedra
  std::vector<std::int32_t> walls_;    // the nodes of the boundary
  ManifoldChange change_;
};

}  // namespace

ManifoldChange make_manifold(std::vector<Vec3>& nodes, std::vector<Tetrahedron>& tetrahedra) {
  return Separation(nodes, tetrahedra).run();
}

}  // namespace palpate::mesher
