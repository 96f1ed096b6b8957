// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/boundary.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

#include "format/to_index.hpp"
#include "mesher/geometry/union_find.hpp"

namespace palpate::mesher {
namespace {

/// The sides of a positive tetrahedron, outward.
constexpr std::array<std::array<std::size_t, 3>, 4> kSides{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct Side {
  Triangle sorted;
  std::int32_t tetrahedron;
  Triangle outward;
};

std::vector<Side> sorted_sides(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<Side> sides;
  sides.reserve(4 * tetrahedra.size());
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    for (const auto& [a, b, c] : kSides) {
      const Triangle outward{tetrahedra[t][a], tetrahedra[t][b], tetrahedra[t][c]};
      Triangle sorted = outward;
      std::sort(sorted.begin(), sorted.end());
      sides.push_back({sorted, static_cast<std::int32_t>(t), outward});
    }
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.sorted < b.sorted; });
  return sides;
}

bool is_even(const Triangle& corners) {
  return (corners[0] < corners[1]) + (corners[1] < corners[2]) + (corners[2] < corners[0]) == 2;
}

void number_parts(Adjacency& found, UnionFind& joined, std::size_t count) {
  std::vector<std::int32_t> number(count, -1);
  for (std::size_t t = 0; t < count; ++t) {
    std::int32_t& part = number[joined.root(t)];
    if (part < 0) part = found.parts++;
    found.part.push_back(part);
  }
}

}  // namespace

Adjacency adjacency(const std::vector<Tetrahedron>& tetrahedra) {
  Adjacency found;
  UnionFind joined(tetrahedra.size());
  std::vector<std::pair<std::int32_t, Triangle>> boundary;
  const std::vector<Side> sides = sorted_sides(tetrahedra);
  for (auto first = sides.begin(); first != sides.end();) {
    const auto end = std::find_if(first, sides.end(),
                                  [&](const Side& side) { return side.sorted != first->sorted; });
    const auto count = end - first;
    if (count == 1) boundary.emplace_back(first->tetrahedron, first->outward);
    if (count == 2) {
      found.shared.push_back({first->sorted, {first->tetrahedron, std::next(first)->tetrahedron}});
    }
    for (auto other = std::next(first); other != end; ++other)
      joined.join(to_index(first->tetrahedron), to_index(other->tetrahedron));
    const bool overlap =
        count > 2 || (count == 2 && is_even(first->outward) == is_even(std::next(first)->outward));
    if (overlap && found.overlaps++ == 0) found.overlap = first->outward;
    first = end;
  }
  std::stable_sort(boundary.begin(), boundary.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [tetrahedron, facet] : boundary) found.boundary.push_back(facet);
  number_parts(found, joined, tetrahedra.size());
  return found;
}

Pinches pinches(const std::vector<Triangle>& closed_surface) {
  // For each corner of each facet: the edges of the facet at that corner lead from one neighbour to
  // the next around it.
  struct Step {
    std::int32_t point, from, to;
  };
  std::vector<Step> steps;
  for (const Triangle& t : closed_surface)
    for (std::size_t k = 0; k < 3; ++k) steps.push_back({t[k], t[(k + 1) % 3], t[(k + 2) % 3]});
  std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) {
    return std::tie(a.point, a.from, a.to) < std::tie(b.point, b.from, b.to);
  });
  Pinches found;
  std::set<Edge> crowded;
  for (std::size_t first = 0, end = 0; first < steps.size(); first = end) {
    std::unordered_map<std::int32_t, std::int32_t> next;
    const std::int32_t point = steps[first].point;
    bool is_crowded = false;
    for (; end < steps.size() && steps[end].point == point; ++end) {
      if (next.emplace(steps[end].from, steps[end].to).second) continue;
      is_crowded = true;
      crowded.insert(edge_between(point, steps[end].from));
    }
    std::size_t around = 0;
    std::int32_t at = steps[first].from;
    do {
      at = next.contains(at) ? next[at] : steps[first].from;
      ++around;
    } while (at != steps[first].from && around < next.size());
    if (!is_crowded && around == next.size()) continue;
    if (!is_crowded) ++found.points;
    found.nodes.push_back(point);
  }
  found.edges.assign(crowded.begin(), crowded.end());
  return found;
}

namespace {

/// The sets of tetrahedra around a node that are connected by faces with the node, as a root each.
std::vector<std::size_t> sets_at(const std::vector<Tetrahedron>& tetrahedra, std::int32_t node,
                                 const std::vector<std::size_t>& around) {
  UnionFind joined(around.size());
  std::map<Edge, std::size_t> first_at;  // by the other two nodes of the face
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Tetrahedron& t = tetrahedra[around[i]];
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b) {
        if (t[a] == node || t[b] == node) continue;
        const auto [entry, is_new] = first_at.emplace(edge_between(t[a], t[b]), i);
        if (!is_new) joined.join(i, entry->second);
      }
  }
  std::vector<std::size_t> set;
  for (std::size_t i = 0; i < around.size(); ++i) set.push_back(joined.root(i));
  return set;
}

}  // namespace

std::vector<std::int32_t> split_nodes(std::vector<Tetrahedron>& tetrahedra, std::size_t nodes) {
  std::map<std::int32_t, std::vector<std::size_t>> around;
  for (const std::int32_t v : pinches(adjacency(tetrahedra).boundary).nodes) around[v];
  for (std::size_t t = 0; t < tetrahedra.size(); ++t)
    for (const std::int32_t v : tetrahedra[t])
      if (const auto found = around.find(v); found != around.end()) found->second.push_back(t);
  std::vector<std::int32_t> origin;
  for (const auto& [node, members] : around) {
    const std::vector<std::size_t> set = sets_at(tetrahedra, node, members);
    std::map<std::size_t, std::int32_t> name{{set.front(), node}};
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto next = static_cast<std::int32_t>(nodes + origin.size());
      const auto [entry, is_new] = name.emplace(set[i], next);
      if (is_new) origin.push_back(node);
      std::replace(tetrahedra[members[i]].begin(), tetrahedra[members[i]].end(), node,
                   entry->second);
    }
  }
  return origin;
}

std::size_t components(const std::vector<Triangle>& surface) {
  std::int32_t largest = -1;
  for (const Triangle& t : surface) largest = std::max({largest, t[0], t[1], t[2]});
  UnionFind joined(static_cast<std::size_t>(largest + 1));
  for (const Triangle& t : surface) {
    joined.join(to_index(t[0]), to_index(t[1]));
    joined.join(to_index(t[0]), to_index(t[2]));
  }
  std::set<std::size_t> roots;
  for (const Triangle& t : surface) roots.insert(joined.root(to_index(t[0])));
  return roots.size();
}

}  // namespace palpate::mesher
