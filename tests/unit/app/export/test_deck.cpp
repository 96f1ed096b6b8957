// SPDX-License-Identifier: AGPL-3.0-or-later
// What is pressed, by what and where, for the input files of other programs; the tool as a mesh.
#include "app/export/deck.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <map>
#include <set>

#include "fem/contact/tool_mesh.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/unit/app/export/decks.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

TEST(Decks, MoveTheSurfaceNodesUnderThePatch) {
  const Deck deck = deck_of({10e3, 0.45});
  // On a grid of 5 mm: the vertex and its four neighbours, and the edges between them: four along
  // the grid, two or so across a cell are longer than the patch but join nodes of it.
  std::set<std::int32_t> corners;
  const auto grid = static_cast<std::int32_t>(block().nodes.size());
  for (const std::int32_t node : deck.patch) {
    EXPECT_NEAR(deck.mesh.X(2, node), 0.01, 1e-12);
    if (node < grid) corners.insert(node);
  }
  EXPECT_EQ(corners.size(), 5u);
  EXPECT_GE(deck.patch.size(), 9u);
}

TEST(Decks, RefuseAPatchOnASupportOrWithoutSize) {
  const Body body = block();
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", {10e3, 0.45}}};
  EXPECT_THROW(make_patch_deck(body, settings, test::site_nearest(body, 0.01, 0.01), 0.02), Error);
  EXPECT_THROW(make_patch_deck(body, settings, test::site_nearest(body, 0.01, 0.01), 0), Error);
  EXPECT_THROW(make_patch_deck(body, settings, 100000, 0.005), Error);
  settings.materials[0].law.at("poisson") = 0.5;
  EXPECT_THROW(make_patch_deck(body, settings, test::site_nearest(body, 0.01, 0.01), 0.005), Error);
}

TEST(Decks, RefuseLinearElements) {
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", {10e3, 0.45}}};
  settings.indentation.tool.radius = 0.004;
  settings.dilatation = fem::Dilatation::LinearNodal;
  const Body body = block();
  const std::int32_t site = test::site_nearest(body, 0.01, 0.01);
  for (const bool patch : {false, true}) {
    try {
      patch ? make_patch_deck(body, settings, site, 0.0052) : make_tool_deck(body, settings, site);
      FAIL() << "a deck was made";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      EXPECT_THAT(error.what(), HasSubstr("solver.element"));
    }
  }
}

Eigen::Vector3d corner_normal(const Eigen::Matrix3Xd& X, const fem::Facet& facet) {
  const Eigen::Vector3d a = X.col(facet[1]) - X.col(facet[0]),
                        b = X.col(facet[2]) - X.col(facet[0]);
  return 0.5 * a.cross(b);
}

/// A point of the quadratic facet, halfway between a corner and the middle of the opposite edge or
/// so.
Eigen::Vector3d inner_point(const Eigen::Matrix3Xd& X, const fem::Facet& facet) {
  const double L[3] = {0.5, 0.3, 0.2};
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    x += L[c] * (2 * L[c] - 1) * X.col(facet[c]);
    x += 4 * L[c] * L[(c + 1) % 3] * X.col(facet[3 + c]);
  }
  return x;
}

TEST(ToolMesh, LiesOnTheToolAndFacesOutwards) {
  for (const fem::ToolGeometry& geometry : kTools) {
    fem::Tool tool{geometry};
    tool.tip = {0.001, 0.002, 0.003};
    tool.inward = Eigen::Vector3d(0.6, 0, -0.8);
    tool.axis = {0, 1, 0};
    const fem::ToolMesh mesh = fem::make_tool_mesh(tool, 0.006);
    double lowest = 1;
    for (const fem::Tetrahedron10& tetrahedron : mesh.tetrahedra) {
      const fem::Facet facet = facet_of(tetrahedron, 0);
      for (const std::int32_t node : facet) {
        EXPECT_LT(std::abs(tool.distance(mesh.X.col(node))), 1e-9 * geometry.radius);
        lowest = std::min(lowest, -tool.beyond_end(mesh.X.col(node)));
      }
      // What a facet of six nodes on the tool leaves of its roundness between them.
      const Eigen::Vector3d between = inner_point(mesh.X, facet);
      const double allowed = geometry.shape == fem::ToolShape::Sphere ? 1e-4 : 1e-3;
      EXPECT_LT(std::abs(tool.distance(between)), allowed * geometry.radius);
      EXPECT_GT(corner_normal(mesh.X, facet).dot(tool.gap(between).normal), 0);
    }
    EXPECT_NEAR(lowest, 0, 1e-12) << "the tip is on the mesh";
  }
}

/// No gaps, no overlaps: each inner edge belongs to two facets, and the area is that of the shape.
TEST(ToolMesh, IsOnePieceOfTheRightArea) {
  for (const fem::ToolGeometry& g : kTools) {
    const double side = 0.006;
    const fem::ToolMesh mesh = fem::make_tool_mesh(fem::Tool{g}, side);
    double area = 0;
    std::map<std::int32_t, int> facets_at_edge;  // by its middle node
    for (const fem::Tetrahedron10& tetrahedron : mesh.tetrahedra) {
      const fem::Facet f = facet_of(tetrahedron, 0);
      for (std::size_t m = 3; m < 6; ++m) ++facets_at_edge[f[m]];
      for (const fem::Facet& part : {fem::Facet{f[0], f[3], f[5]}, fem::Facet{f[3], f[1], f[4]},
                                     fem::Facet{f[5], f[4], f[2]}, fem::Facet{f[3], f[4], f[5]}})
        area += corner_normal(mesh.X, part).norm();
    }
    const double R = g.radius, e = g.edge_radius;
    double expected = 2 * M_PI * R * R;
    if (g.shape == fem::ToolShape::Cylinder) expected += M_PI * R * g.length;
    if (g.shape == fem::ToolShape::Disc)
      expected = M_PI * (R - e) * (R - e) + M_PI * M_PI * (R - e) * e + 2 * M_PI * e * e +
                 2 * M_PI * R * side;
    EXPECT_NEAR(area / expected, 1, 3e-3) << name_of(g.shape);
    for (const auto& [node, facets] : facets_at_edge) EXPECT_LE(facets, 2);
  }
}

TEST(Decks, PressTheToolAgainstTheSkinThatItMayMeet) {
  const Body body = block();
  for (const fem::ToolGeometry& tool : kTools) {
    const Deck deck = make_tool_deck(body, pressed_by(tool), test::site_nearest(body, 0.01, 0.01));
    ASSERT_TRUE(deck.tool.has_value());
    EXPECT_TRUE(deck.patch.empty());
    // On a flat top the tip starts on the site.
    double lowest = 1;
    for (Eigen::Index i = 0; i < deck.tool->mesh.X.cols(); ++i)
      lowest = std::min(lowest, deck.tool->mesh.X(2, i));
    EXPECT_NEAR(lowest, 0.01, 1e-9);
    double top = 0;
    for (const ElementSide& s : deck.tool->skin) {
      const fem::Facet facet = facet_of(deck.mesh.tetrahedra[to_index(s.element)], s.side);
      const Eigen::Vector3d area = corner_normal(deck.mesh.X, facet);
      if (area[2] > 0.9 * area.norm()) top += area[2];
      for (std::size_t m = 0; m < 3; ++m) {
        const Eigen::Vector3d between =
            0.5 * (deck.mesh.X.col(facet[m]) + deck.mesh.X.col(facet[(m + 1) % 3]));
        EXPECT_LT((deck.mesh.X.col(facet[3 + m]) - between).norm(), 1e-12);
      }
    }
    EXPECT_NEAR(top, 0.02 * 0.02, 1e-9) << "all of the top is within reach here";
  }
}

/// The elements under the tool are divided, the body stays the same.
TEST(Decks, HaveTheRefinedElementsOfTheSite) {
  const Body body = block();
  const std::int32_t site = test::site_nearest(body, 0.01, 0.01);
  fem::CampaignSettings settings = pressed_by(kTools[0]);
  const Deck coarse = make_tool_deck(body, settings, site);
  settings.indentation.refine_under_tool = 2;
  const Deck fine = make_tool_deck(body, settings, site);
  const auto top = [](const Deck& deck, bool smallest) {
    double sum = 0, least = 1;
    for (const ElementSide& s : deck.tool->skin) {
      const fem::Facet facet = facet_of(deck.mesh.tetrahedra[to_index(s.element)], s.side);
      const Eigen::Vector3d area = corner_normal(deck.mesh.X, facet);
      if (area[2] < 0.9 * area.norm()) continue;
      sum += area[2];
      least = std::min(least, area[2]);
    }
    return smallest ? least : sum;
  };
  EXPECT_NEAR(top(fine, false), top(coarse, false), 1e-12);
  EXPECT_NEAR(top(fine, true), top(coarse, true) / 16, 1e-12);
  EXPECT_EQ(fine.mesh.region.size(), fine.mesh.tetrahedra.size());
  EXPECT_THROW(make_patch_deck(body, settings, site, 0.0052), Error);
}

TEST(Decks, RefuseToolsThatOtherProgramsHoldInTheirOwnWay) {
  const Body body = block();
  fem::CampaignSettings settings = pressed_by({fem::ToolShape::Disc, 0.004, 0, 0});
  EXPECT_THROW(make_tool_deck(body, settings, test::site_nearest(body, 0.01, 0.01)), Error);
  EXPECT_THROW(make_tool_deck(body, pressed_by(kTools[0]), -1), Error);
  settings = pressed_by(kTools[0]);
  settings.indentation.azimuths.clear();
  EXPECT_THROW(make_tool_deck(body, settings, test::site_nearest(body, 0.01, 0.01), true), Error);
}

}  // namespace
}  // namespace palpate::app
