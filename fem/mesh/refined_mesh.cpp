// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/refined_mesh.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <utility>

#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

using Volume = std::array<double, 4>;  ///< volume coordinates

/// The corners of the face opposite to each corner.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

std::array<double, kTetNodes> shape_functions(const Volume& L) {
  std::array<double, kTetNodes> N{};
  for (std::size_t c = 0; c < 4; ++c) N[c] = L[c] * (2 * L[c] - 1);
  for (std::size_t e = 0; e < 6; ++e) N[4 + e] = 4 * L[kTetEdges[e][0]] * L[kTetEdges[e][1]];
  return N;
}

/// Volume coordinates of a node of an element.
Volume volume_coordinates(std::size_t node) {
  Volume L{};
  if (node < 4) {
    L[node] = 1;
  } else {
    for (const std::size_t corner : kTetEdges[node - 4]) L[corner] = 0.5;
  }
  return L;
}

/// A child of an element: four nodes of the element.
using Child = std::array<std::size_t, 4>;

constexpr unsigned kAllEdges = 0b111111;
/// The edges of each face, one bit an edge; faces opposite to the corners 0..3.
constexpr std::array<unsigned, 4> kFaceEdges{0b110010, 0b101100, 0b011001, 0b000111};

/// The smallest set of split edges that contains `edges` and can be matched by neighbours on every
/// face: no face has two split edges.
unsigned completed(unsigned edges) {
  for (bool grown = true; grown;) {
    grown = false;
    for (const unsigned face : kFaceEdges)
      if (std::popcount(edges & face) == 2) {
        edges |= face;
        grown = true;
      }
  }
  const bool face = std::ranges::find(kFaceEdges, edges) != kFaceEdges.end();
  return std::popcount(edges) >= 3 && !face ? kAllEdges : edges;
}

/// Four at the corners, and the octahedron between them in four along its shortest diagonal.
template <class Position>
std::vector<Child> children_in_eight(const Position& position, const Tetrahedron10& node) {
  // Mid-edge nodes: 4 = 01, 5 = 12, 6 = 20, 7 = 03, 8 = 13, 9 = 23. Opposite ones span a diagonal
  // of the octahedron; the other four go around it.
  struct Diagonal {
    std::size_t from, to;
    std::array<std::size_t, 4> around;
  };
  constexpr std::array<Diagonal, 3> kDiagonals{
      {{4, 9, {5, 8, 7, 6}}, {5, 7, {4, 6, 9, 8}}, {6, 8, {4, 7, 9, 5}}}};
  const auto length = [&](const Diagonal& d) {
    return (position(node[d.from]) - position(node[d.to])).squaredNorm();
  };
  const Diagonal* shortest = &kDiagonals[0];
  for (const Diagonal& d : kDiagonals)
    if (length(d) < (1 - 1e-9) * length(*shortest)) shortest = &d;
  std::vector<Child> parts{{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};
  for (std::size_t i = 0; i < 4; ++i)
    parts.push_back(
        {shortest->from, shortest->to, shortest->around[i], shortest->around[(i + 1) % 4]});
  return parts;
}

/// Along edges without a common corner: each child has one end of each.
std::vector<Child> children_along(const std::vector<std::size_t>& edges) {
  std::vector<Child> parts{{0, 1, 2, 3}};
  for (const std::size_t edge : edges) {
    std::vector<Child> halves;
    for (const Child& part : parts)
      for (const std::size_t end : kTetEdges[edge]) {
        halves.push_back(part);
        std::ranges::replace(halves.back(), end, 4 + edge);
      }
    parts.swap(halves);
  }
  return parts;
}

/// A face in four, each joined to the corner opposite.
std::vector<Child> children_of_face(std::size_t apex) {
  const auto& [i, j, k] = kFaces[apex];
  const std::size_t ij = middle_node(i, j), jk = middle_node(j, k), ki = middle_node(k, i);
  return {{i, ij, ki, apex}, {ij, j, jk, apex}, {ki, jk, k, apex}, {ij, jk, ki, apex}};
}

template <class Position>
std::vector<Child> children(const Position& position, const Tetrahedron10& node, unsigned edges) {
  if (edges == kAllEdges) return children_in_eight(position, node);
  for (std::size_t apex = 0; apex < 4; ++apex)
    if (edges == kFaceEdges[apex]) return children_of_face(apex);
  std::vector<std::size_t> apart;
  for (std::size_t e = 0; e < 6; ++e)
    if (edges >> e & 1U) apart.push_back(e);
  return children_along(apart);
}

/// Volume of a child over that of its parent, if the parent had straight edges.
double straight_volume(const Child& child) {
  Eigen::Matrix4d corners;
  for (int c = 0; c < 4; ++c)
    corners.col(c) = Eigen::Vector4d(volume_coordinates(child[to_index(c)]).data());
  return corners.determinant();
}

template <class Position>
double six_volumes(const Position& position, const Tetrahedron10& node, const Child& child) {
  Eigen::Matrix3d edges;
  for (int c = 0; c < 3; ++c)
    edges.col(c) = position(node[child[to_index(c + 1)]]) - position(node[child[0]]);
  return edges.determinant();
}

/// An element that is not divided yet, and where it lies in its element of the unrefined mesh.
struct Leaf {
  Tetrahedron10 node;
  std::int32_t base;             ///< element of the unrefined mesh
  std::array<Volume, 4> corner;  ///< in `base`
  int level;                     ///< how often `base` was divided into eight
};

/// Volume coordinates in `base` of a node of a leaf.
Volume coordinates_in_base(const Leaf& leaf, std::size_t node) {
  if (node < 4) return leaf.corner[node];
  const auto& [i, j] = kTetEdges[node - 4];
  Volume L{};
  for (std::size_t c = 0; c < 4; ++c) L[c] = 0.5 * (leaf.corner[i][c] + leaf.corner[j][c]);
  return L;
}

/// Divides elements, level by level, into eight; what else conformity requires is divided at the
/// end, so that no child of such a closure is divided again. A common edge of two elements gets one
/// middle node.
class Refiner {
 public:
  explicit Refiner(const QuadraticMesh& whole)
      : whole_(whole), split_(to_index(whole.nodes()), false) {
    for (std::int32_t e = 0; e < static_cast<std::int32_t>(whole.tetrahedra.size()); ++e) {
      leaves_.push_back({whole.tetrahedra[to_index(e)], e, {}, 0});
      for (std::size_t c = 0; c < 4; ++c) leaves_.back().corner[c] = volume_coordinates(c);
    }
  }

  RefinedMesh run(std::vector<int> elements, int levels, const ElementChoice& choose) && {
    for (int level = 1; level < levels; ++level) {
      divide(elements);
      elements = chosen(level, choose);
    }
    for (const int e : elements) split_all_edges(leaves_[to_index(e)]);
    choose_edges();
    for (std::vector<int> rest = irregular(); !rest.empty(); rest = irregular()) {
      divide(rest);
      choose_edges();
    }
    for (std::size_t i = 0; i < leaves_.size(); ++i)
      if (edges_[i] == 0) add_element(leaves_[i]);
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      if (edges_[i] == 0) continue;
      const Leaf leaf = leaves_[i];
      for (const Leaf& child : children_of(leaf, edges_[i])) add_element(child);
    }
    add_facets();
    place_nodes();
    return std::move(refined_);
  }

 private:
  Eigen::Vector3d position(std::int32_t node) const {
    if (node < whole_.nodes()) return whole_.X.col(node);
    return made_[to_index(node - whole_.nodes())];
  }

  void split_all_edges(const Leaf& leaf) {
    for (std::size_t edge = 0; edge < 6; ++edge) split_[to_index(leaf.node[4 + edge])] = true;
  }

  std::vector<int> chosen(int level, const ElementChoice& choose) const {
    std::vector<int> wanted;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      const Leaf& leaf = leaves_[i];
      if (leaf.level != level) continue;
      if (choose({position(leaf.node[0]), position(leaf.node[1]), position(leaf.node[2]),
                  position(leaf.node[3])},
                 level))
        wanted.push_back(static_cast<int>(i));
    }
    return wanted;
  }

  /// Replaces leaves by their eight children, behind the others.
  void divide(const std::vector<int>& which) {
    std::vector<bool> gone(leaves_.size(), false);
    std::vector<Leaf> added;
    for (const int i : which) {
      gone[to_index(i)] = true;
      const Leaf leaf = leaves_[to_index(i)];
      split_all_edges(leaf);
      for (const Leaf& child : children_of(leaf, kAllEdges)) added.push_back(child);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < leaves_.size(); ++i)
      if (!gone[i]) leaves_[kept++] = leaves_[i];
    leaves_.resize(kept);
    leaves_.insert(leaves_.end(), added.begin(), added.end());
  }

  /// Marks the mid-edge nodes of split edges until the marks of every element are complete.
  void choose_edges() {
    edges_.assign(leaves_.size(), 0U);
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t e = 0; e < leaves_.size(); ++e) {
        const Tetrahedron10& node = leaves_[e].node;
        unsigned edges = 0;
        for (std::size_t edge = 0; edge < 6; ++edge)
          if (split_[to_index(node[4 + edge])]) edges |= 1U << edge;
        edges_[e] = completed(edges);
        if (edges_[e] == edges) continue;
        grown = true;
        for (std::size_t edge = 0; edge < 6; ++edge)
          if (edges_[e] >> edge & 1U) split_[to_index(node[4 + edge])] = true;
      }
    }
  }

  /// The leaves that neighbours have divided twice: half of an edge, or an edge between the middles
  /// of two edges of a face, is split.
  std::vector<int> irregular() const {
    std::vector<int> found;
    if (middle_.empty()) return found;
    for (std::size_t i = 0; i < leaves_.size(); ++i)
      if (edges_[i] != 0 && divided_twice(leaves_[i].node, edges_[i]))
        found.push_back(static_cast<int>(i));
    return found;
  }

  bool divided_twice(const Tetrahedron10& node, unsigned edges) const {
    const auto split = [&](std::size_t a, std::size_t b) {
      const auto entry = middle_.find(edge_between(node[a], node[b]));
      return entry != middle_.end() && split_[to_index(entry->second)];
    };
    for (std::size_t e = 0; e < 6; ++e) {
      if (!(edges >> e & 1U)) continue;
      if (split(kTetEdges[e][0], 4 + e) || split(kTetEdges[e][1], 4 + e)) return true;
      for (std::size_t other = e + 1; other < 6; ++other)
        if (split(4 + e, 4 + other)) return true;
    }
    return false;
  }

  void add_element(const Leaf& leaf) {
    refined_.mesh.tetrahedra.push_back(leaf.node);
    refined_.mesh.region.push_back(whole_.region[to_index(leaf.base)]);
    refined_.parent.push_back(leaf.base);
  }

  /// The node between two nodes of a leaf; exists already where they are corners.
  std::int32_t middle(const Leaf& leaf, std::size_t a, std::size_t b) {
    if (a < 4 && b < 4) return leaf.node[middle_node(a, b)];
    const auto next = whole_.nodes() + static_cast<std::int32_t>(refined_.new_nodes.size());
    const auto [entry, added] = middle_.try_emplace(edge_between(leaf.node[a], leaf.node[b]), next);
    if (!added) return entry->second;
    const Volume La = coordinates_in_base(leaf, a), Lb = coordinates_in_base(leaf, b);
    Volume L{};
    for (std::size_t c = 0; c < 4; ++c) L[c] = 0.5 * (La[c] + Lb[c]);
    add_node(leaf.base, L);
    return next;
  }

  void add_node(std::int32_t base, const Volume& L) {
    const Tetrahedron10& node = whole_.tetrahedra[to_index(base)];
    const std::array<double, kTetNodes> N = shape_functions(L);
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (std::size_t a = 0; a < kTetNodes; ++a) x += N[a] * whole_.X.col(node[a]);
    refined_.new_nodes.push_back({base, N});
    made_.push_back(x);
    fixed_.push_back(all_fixed_around(node, L));
    split_.push_back(false);
  }

  /// Whether every node of the edge, face or element on which a point lies is fixed.
  bool all_fixed_around(const Tetrahedron10& node, const Volume& L) const {
    for (std::size_t a = 0; a < kTetNodes; ++a) {
      const Volume of = volume_coordinates(a);
      bool on = true;
      for (std::size_t c = 0; c < 4; ++c) on = on && (of[c] == 0 || L[c] > 0);
      if (on && !whole_.fixed[to_index(node[a])]) return false;
    }
    return true;
  }

  std::vector<Leaf> children_of(const Leaf& leaf, unsigned edges) {
    std::vector<Leaf> made;
    const auto at = [this](std::int32_t node) { return position(node); };
    for (Child child : children(at, leaf.node, edges)) {
      if (straight_volume(child) < 0) std::swap(child[2], child[3]);
      if (!(six_volumes(at, leaf.node, child) > 0)) refuse(leaf.base);
      Leaf next{{}, leaf.base, {}, leaf.level + 1};
      for (std::size_t c = 0; c < 4; ++c) {
        next.node[c] = leaf.node[child[c]];
        next.corner[c] = coordinates_in_base(leaf, child[c]);
      }
      for (std::size_t e = 0; e < 6; ++e)
        next.node[4 + e] = middle(leaf, child[kTetEdges[e][0]], child[kTetEdges[e][1]]);
      made.push_back(next);
    }
    return made;
  }

  [[noreturn]] static void refuse(int element) {
    throw Error(ErrorKind::Geometry, "element " + std::to_string(element) + " of the body",
                "cannot be refined: its curved edges invert a child",
                "mesh the body again, or choose a smaller mesh.element_size instead of "
                "solver.refine_under_tool");
  }

  /// After the elements: all middle nodes exist. The children of a facet on springs are on them
  /// too.
  void add_facets() {
    auto sprung = whole_.sprung.begin();
    for (std::size_t f = 0; f < whole_.facets.size(); ++f) {
      const std::size_t first = refined_.mesh.facets.size();
      add_facet(whole_.facets[f], whole_.facet_region[f]);
      if (sprung == whole_.sprung.end() || to_index(sprung->facet) != f) continue;
      for (std::size_t child = first; child < refined_.mesh.facets.size(); ++child)
        refined_.mesh.sprung.push_back({static_cast<std::int32_t>(child), sprung->normal_stiffness,
                                        sprung->tangential_stiffness});
      ++sprung;
    }
  }

  /// A facet, or its children where edges are split.
  void add_facet(const Facet& facet, std::int32_t region) {
    // Corners 0..2, then the edges 01, 12, 20.
    std::vector<std::array<std::size_t, 3>> parts;
    std::vector<std::size_t> split;
    for (std::size_t edge = 0; edge < 3; ++edge)
      if (split_[to_index(facet[3 + edge])]) split.push_back(edge);
    if (split.empty()) {
      refined_.mesh.facets.push_back(facet);
      refined_.mesh.facet_region.push_back(region);
      return;
    }
    if (split.size() == 1) {
      const std::size_t from = split[0], to = (from + 1) % 3, across = (from + 2) % 3;
      parts = {{from, 3 + from, across}, {3 + from, to, across}};
    } else {
      parts = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    }
    for (const auto& part : parts) {
      Facet nodes{};
      for (std::size_t c = 0; c < 3; ++c) {
        nodes[c] = facet[part[c]];
        nodes[3 + c] = middle_of_facet(facet, part[c], part[(c + 1) % 3]);
      }
      add_facet(nodes, region);
    }
  }

  std::int32_t middle_of_facet(const Facet& facet, std::size_t a, std::size_t b) const {
    if (a < 3 && b < 3) return facet[3 + ((a + 1) % 3 == b ? a : b)];
    return middle_.at(edge_between(facet[a], facet[b]));
  }

  void place_nodes() {
    const auto made = static_cast<Eigen::Index>(made_.size());
    refined_.mesh.X.resize(3, whole_.X.cols() + made);
    refined_.mesh.X.leftCols(whole_.X.cols()) = whole_.X;
    for (Eigen::Index i = 0; i < made; ++i)
      refined_.mesh.X.col(whole_.X.cols() + i) = made_[static_cast<std::size_t>(i)];
    refined_.mesh.fixed = whole_.fixed;
    refined_.mesh.fixed.insert(refined_.mesh.fixed.end(), fixed_.begin(), fixed_.end());
  }

  const QuadraticMesh& whole_;
  RefinedMesh refined_;
  std::vector<Leaf> leaves_;
  std::vector<unsigned> edges_;          ///< of each leaf, its split edges, one bit each
  std::vector<bool> split_;              ///< of each node, whether it is the middle of a split edge
  std::vector<Eigen::Vector3d> made_;    ///< position of each new node
  std::vector<bool> fixed_;              ///< of each new node
  std::map<Edge, std::int32_t> middle_;  ///< of two nodes, where it is a new node
};

}  // namespace

RefinedMesh refine_elements(const QuadraticMesh& mesh, const std::vector<int>& elements, int levels,
                            const ElementChoice& choose) {
  return Refiner(mesh).run(elements, levels, choose);
}

}  // namespace palpate::fem
