// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/unit/mesher/body_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "format/edge.hpp"

namespace palpate::mesher::test {
namespace {

const Vec3& node(const Body& body, std::int32_t i) {
  return body.nodes.at(static_cast<std::size_t>(i));
}

double six_volume(const Body& body, const Tetrahedron& t) {
  const Vec3& a = node(body, t[0]);
  return dot(cross(node(body, t[1]) - a, node(body, t[2]) - a), node(body, t[3]) - a);
}

Vec3 area_vector(const Body& body, const Triangle& t) {
  const Vec3& a = node(body, t[0]);
  return cross(node(body, t[1]) - a, node(body, t[2]) - a);
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

Triangle response_nodes(const Body& body, const Triangle& t) {
  const auto at = [&](std::size_t k) {
    return body.response.node.at(static_cast<std::size_t>(t[k]));
  };
  return {at(0), at(1), at(2)};
}

void expect_boundary_is_skin_of_tetrahedra(const Body& body) {
  std::map<Triangle, int> faces;
  for (const Tetrahedron& t : body.tetrahedra) {
    for (const Triangle& face : {Triangle{t[1], t[2], t[3]}, Triangle{t[0], t[2], t[3]},
                                 Triangle{t[0], t[1], t[3]}, Triangle{t[0], t[1], t[2]}}) {
      ++faces[sorted(face)];
    }
  }
  std::size_t single = 0, foreign = 0;
  for (const auto& [face, count] : faces) {
    EXPECT_LE(count, 2);
    if (count == 1) ++single;
  }
  for (const Triangle& t : body.boundary) {
    const auto found = faces.find(sorted(t));
    if (found == faces.end() || found->second != 1) ++foreign;
  }
  EXPECT_EQ(single, body.boundary.size());
  EXPECT_EQ(foreign, 0U);
}

void expect_closed(const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> directed;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
  }
  std::size_t unpaired = 0;
  for (const auto& [edge, count] : directed) {
    if (count != 1 || !directed.contains({edge.second, edge.first})) ++unpaired;
  }
  EXPECT_EQ(unpaired, 0U);
}

/// Smallest |sum n_l u_l| on a fine grid of natural coordinates.
double sampled_mean_norm(const Body& body, const Triangle& t) {
  constexpr int n = 20;
  double least = 1;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      const double a = static_cast<double>(i) / n, b = static_cast<double>(j) / n;
      const auto u = [&](std::size_t k) {
        return body.response.inward[static_cast<std::size_t>(t[k])];
      };
      least = std::min(least, norm(a * u(0) + b * u(1) + (1 - a - b) * u(2)));
    }
  }
  return least;
}

void expect_loadable(const Body& body) {
  const ResponseSurface& response = body.response;
  std::size_t folded = 0, weak = 0;
  for (const Triangle& t : response.triangles) {
    const auto is_site = [&](std::int32_t v) {
      return response.is_site[static_cast<std::size_t>(v)] != 0;
    };
    if (!std::all_of(t.begin(), t.end(), is_site)) continue;
    const Vec3 outward = area_vector(body, response_nodes(body, t));
    for (const std::int32_t v : t) {
      if (dot(response.inward[static_cast<std::size_t>(v)], outward) >= 0) ++folded;
    }
    if (sampled_mean_norm(body, t) < 0.5) ++weak;
  }
  EXPECT_EQ(folded, 0U);
  EXPECT_EQ(weak, 0U);
}

}  // namespace

double volume_of_region(const Body& body, std::int32_t region) {
  double sum = 0;
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    if (region < 0 || body.tetrahedron_region[t] == region) {
      sum += six_volume(body, body.tetrahedra[t]) / 6;
    }
  }
  return sum;
}

double boundary_volume(const Body& body) {
  double sum = 0;
  for (const Triangle& t : body.boundary) sum += dot(node(body, t[0]), area_vector(body, t)) / 6;
  return sum;
}

double boundary_area(const Body& body) {
  double sum = 0;
  for (const Triangle& t : body.boundary) sum += norm(area_vector(body, t)) / 2;
  return sum;
}

int euler_characteristic(const Body& body) {
  std::set<std::int32_t> nodes;
  for (const Triangle& t : body.boundary) nodes.insert(t.begin(), t.end());
  return static_cast<int>(nodes.size()) - static_cast<int>(edges_of(body.boundary).size()) +
         static_cast<int>(body.boundary.size());
}

void expect_sound(const Body& body) {
  ASSERT_FALSE(body.tetrahedra.empty());
  ASSERT_EQ(body.tetrahedron_region.size(), body.tetrahedra.size());
  std::set<std::int32_t> used;
  for (const Tetrahedron& t : body.tetrahedra) {
    EXPECT_GT(six_volume(body, t), 0);
    used.insert(t.begin(), t.end());
  }
  EXPECT_EQ(used.size(), body.nodes.size()) << "nodes of no tetrahedron";
  expect_boundary_is_skin_of_tetrahedra(body);
  expect_closed(body.boundary);
  expect_closed(body.response.triangles);
  EXPECT_NEAR(volume_of_region(body, -1) / boundary_volume(body), 1, 1e-9);
  EXPECT_TRUE(std::is_sorted(body.fixed_nodes.begin(), body.fixed_nodes.end()));
  const std::set<std::int32_t> fixed(body.fixed_nodes.begin(), body.fixed_nodes.end());
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    EXPECT_NEAR(norm(body.response.inward[v]), 1, 1e-12);
    if (fixed.contains(body.response.node[v])) {
      EXPECT_EQ(body.response.is_site[v], 0);
    }
  }
  expect_loadable(body);
}

void expect_nested(const Body& body, int n) {
  const auto count = static_cast<std::size_t>(n);
  ASSERT_EQ(body.boundary.size(), body.response.triangles.size() * count * count);
  std::set<std::int32_t> boundary_nodes;
  for (const Triangle& t : body.boundary) boundary_nodes.insert(t.begin(), t.end());
  for (const std::int32_t v : body.response.node) EXPECT_TRUE(boundary_nodes.contains(v));
  // The facets of a patch come together; their outline must be that of the patch.
  for (std::size_t m = 0; m < body.response.triangles.size(); ++m) {
    std::map<std::pair<std::int32_t, std::int32_t>, int> directed;
    for (std::size_t f = m * count * count; f < (m + 1) * count * count; ++f) {
      const Triangle& t = body.boundary[f];
      for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
    }
    std::map<std::int32_t, std::int32_t> outline;
    for (const auto& [edge, uses] : directed) {
      EXPECT_EQ(uses, 1);
      if (!directed.contains({edge.second, edge.first})) outline[edge.first] = edge.second;
    }
    ASSERT_EQ(outline.size(), 3 * count);
    const Triangle corners = response_nodes(body, body.response.triangles[m]);
    std::int32_t v = corners[0];
    for (std::size_t k = 0; k < 3 * count; ++k) {
      if (k % count == 0) {
        EXPECT_EQ(v, corners[k / count]);
      }
      ASSERT_TRUE(outline.contains(v));
      v = outline.at(v);
    }
    EXPECT_EQ(v, corners[0]);
  }
}

}  // namespace palpate::mesher::test
