// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/site_body.hpp"

#include <gtest/gtest.h>

#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

class SiteBodies : public testing::Test {
 protected:
  Body body = test::make_block(test::even(-0.02, 0.02, 8), test::even(-0.02, 0.02, 8),
                               test::even(-0.02, 0, 4));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.45, "t")}};
  Displacement rest = 1e-4 * Displacement::Random(3, model.mesh().nodes());
  Eigen::Vector3d site = Eigen::Vector3d(0.001, 0.002, 0);
  ToolGeometry tool;  // a sphere of 5 mm
};

TEST_F(SiteBodies, WholeBodyIsTheBodyItself) {
  const SiteBody s(model, rest, site, tool, SiteMesh::WholeBody);
  EXPECT_EQ(&s.whole(), &model);
  EXPECT_EQ(s.prolongation(), nullptr);
  EXPECT_EQ(s.rest(), rest);
  EXPECT_EQ(s.bytes(), 0);
}

TEST_F(SiteBodies, WindowFreesTheNodesWithinItsRadius) {
  const SiteBody s(model, rest, site, tool, SiteMesh::Window);
  EXPECT_EQ(&s.whole(), &model);
  EXPECT_EQ(s.prolongation(), nullptr);
  EXPECT_GT(s.bytes(), 0);
  int free = 0;
  for (int node = 0; node < model.mesh().nodes(); ++node) {
    const bool near = (model.mesh().X.col(node) - site).norm() <= window_radius(tool);
    EXPECT_EQ(s.window().equation(node) >= 0, near && model.mesh().is_free(node));
    free += s.window().equation(node) >= 0 ? 1 : 0;
  }
  EXPECT_GT(free, 50);
  EXPECT_EQ(s.window().pattern().n, 3 * free);
}

TEST_F(SiteBodies, WindowReachesARadiusBeyondTheTool) {
  EXPECT_DOUBLE_EQ(window_radius(tool), 0.01);
  const ToolGeometry cylinder{ToolShape::Cylinder, 0.005, 0, 0.02};
  EXPECT_DOUBLE_EQ(window_radius(cylinder), 0.015 + 0.005);
}

/// Otherwise the factor of the unrefined body would not serve.
TEST_F(SiteBodies, RefinedWindowContainsEveryNewNode) {
  const int old_nodes = model.mesh().nodes();
  const auto field = [](const Eigen::Vector3d& X) {
    return Eigen::Vector3d(0.1 * X[2] * X[0], 0.02 * X[1] - X[2] * X[2], 0.3 * X[0] * X[1]);
  };
  for (int node = 0; node < old_nodes; ++node) rest.col(node) = field(model.mesh().X.col(node));
  std::size_t elements = model.mesh().tetrahedra.size();
  for (const int levels : {1, 2, 3}) {
    const SiteBody s(model, rest, site, tool, SiteMesh::RefinedWindow, {.levels = levels});
    ASSERT_GT(s.mesh().nodes(), old_nodes);
    ASSERT_NE(s.prolongation(), nullptr);
    for (int node = old_nodes; node < s.mesh().nodes(); ++node)
      EXPECT_TRUE(s.window().equation(node) >= 0 || s.mesh().fixed[to_index(node)]);
    EXPECT_GT(s.mesh().tetrahedra.size(), elements + 100);
    elements = s.mesh().tetrahedra.size();
    EXPECT_EQ(s.rest().leftCols(old_nodes), rest);
    for (int node = old_nodes; node < s.mesh().nodes(); ++node)
      EXPECT_LT((s.rest().col(node) - field(s.mesh().X.col(node))).norm(), 1e-15);
  }
}

double distance_of_centre(const QuadraticMesh& mesh, const Tetrahedron10& t,
                          const Eigen::Vector3d& x) {
  return (0.25 * (mesh.X.col(t[0]) + mesh.X.col(t[1]) + mesh.X.col(t[2]) + mesh.X.col(t[3])) - x)
      .norm();
}

double longest_edge(const QuadraticMesh& mesh, const Tetrahedron10& t) {
  double longest = 0;
  for (const auto& [i, j] : kTetEdges)
    longest = std::max(longest, (mesh.X.col(t[i]) - mesh.X.col(t[j])).norm());
  return longest;
}

ContactCore contact_around(const Eigen::Vector3d& centre, double smallest, double largest) {
  ContactCore core;
  core.centre = centre;
  core.smallest = smallest;
  core.largest = largest;
  return core;
}

/// The elements that a contact of radius r meets are as small as r asks for, and where the smallest
/// contact does not ask for it, no element is divided.
TEST_F(SiteBodies, ContactDividesInProportionToTheDistance) {
  const SiteRefinement asked{
      .levels = 0, .cores = {contact_around(site, 0.0008, 0.004)}, .size_over_distance = 1};
  const SiteBody s(model, rest, site, tool, SiteMesh::RefinedWindow, asked);
  for (const Tetrahedron10& t : s.mesh().tetrahedra) {
    const double r = distance_of_centre(s.mesh(), t, site), longest = longest_edge(s.mesh(), t);
    if (r > 0.004) continue;
    EXPECT_LT(longest, 1.5 * std::max(0.0008, r));
    EXPECT_GT(longest, 0.15 * std::max(0.0008, r));
  }
  for (int node = model.mesh().nodes(); node < s.mesh().nodes(); ++node)
    EXPECT_TRUE(s.window().equation(node) >= 0 || s.mesh().fixed[to_index(node)]);
}

/// With each halving of the smallest radius about as many elements are added.
TEST_F(SiteBodies, ContactsOfAnyRadiusCostTheSame) {
  std::vector<std::size_t> elements;
  for (const double radius : {0.002, 0.001, 0.0005, 0.00025}) {
    const SiteRefinement asked{
        .levels = 0, .cores = {contact_around(site, radius, 0.004)}, .size_over_distance = 1};
    elements.push_back(
        SiteBody(model, rest, site, tool, SiteMesh::RefinedWindow, asked).mesh().tetrahedra.size());
  }
  const auto first = elements[1] - elements[0], last = elements[3] - elements[2];
  EXPECT_GT(first, 50u);
  EXPECT_LT(last, 2 * first);
  EXPECT_GT(last, first / 2);
}

/// Elements of the body that are larger than the last contact begin close outside of its edge.
TEST_F(SiteBodies, ContactDividesWhatItsLastEdgeMeetsAndLittleBeyond) {
  const Body coarse = test::make_block(test::even(-0.04, 0.04, 4), test::even(-0.04, 0.04, 4),
                                       test::even(-0.04, 0, 2));
  const SolidModel of_coarse{coarse, {NeoHookean::from_young_poisson(10e3, 0.45, "t")}};
  const Displacement undeformed = Displacement::Zero(3, of_coarse.mesh().nodes());
  const double b = 0.004, size = 1.75;
  SiteRefinement asked{
      .levels = 0, .cores = {contact_around(site, 0.001, b)}, .size_over_distance = size};
  std::vector<std::size_t> elements;
  for (const double growth : {0.25 * size, 10.0}) {
    asked.growth_outside = growth;
    const SiteBody s(of_coarse, undeformed, site, tool, SiteMesh::RefinedWindow, asked);
    for (const Tetrahedron10& t : s.mesh().tetrahedra) {
      if (distance_of_centre(s.mesh(), t, site) >= b) continue;
      EXPECT_LT(longest_edge(s.mesh(), t), 1.5 * size * b / 2);
    }
    elements.push_back(s.mesh().tetrahedra.size());
  }
  EXPECT_LT(elements[1], 0.7 * static_cast<double>(elements[0]));
}

TEST_F(SiteBodies, ContactLargerThanTheElementsDividesNone) {
  const SiteRefinement asked{
      .levels = 0, .cores = {contact_around(site, 0.02, 0.03)}, .size_over_distance = 1};
  const SiteBody s(model, rest, site, tool, SiteMesh::RefinedWindow, asked);
  EXPECT_EQ(s.mesh().tetrahedra.size(), model.mesh().tetrahedra.size());
}

/// A homogeneous deformation has the same energy and nodal forces on both meshes.
TEST_F(SiteBodies, RefinedBodyIsTheBodyUnderHomogeneousDeformation) {
  const SiteBody s(model, rest, site, tool, SiteMesh::RefinedWindow, {.levels = 3});
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  G.col(2) = Eigen::Vector3d(0.1, -0.05, -0.08);  // vanishes at the fixed base
  const auto homogeneous = [&](const QuadraticMesh& mesh) {
    return Displacement(G * (mesh.X.colwise() + Eigen::Vector3d(0, 0, 0.02)));
  };
  Eigen::VectorXd coarse, fine;
  const double energy = model.forces(homogeneous(model.mesh()), coarse).energy;
  EXPECT_NEAR(s.whole().forces(homogeneous(s.mesh()), fine).energy, energy, 1e-12 * energy);
  EXPECT_LT((s.prolongation()->reduced(fine) - coarse).norm(), 1e-10 * coarse.norm());
}

}  // namespace
}  // namespace palpate::fem
