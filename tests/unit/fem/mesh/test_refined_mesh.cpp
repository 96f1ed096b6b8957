// SPDX-License-Identifier: AGPL-3.0-or-later
// Elements refined under the tool, against bodies that are refined as a whole beforehand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "fem/campaign/campaign.hpp"
#include "fem/campaign/indentation.hpp"
#include "fem/mesh/refined_mesh.hpp"
#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;

Body block_of(int across) {
  return test::make_block(test::even(-0.015, 0.015, across), test::even(-0.015, 0.015, across),
                          test::even(-0.015, 0, across / 2));
}

std::vector<int> all_elements(const QuadraticMesh& mesh) {
  std::vector<int> all(mesh.tetrahedra.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// A body whose elements are the children of all elements of another, with its sites.
Body refined_body(const Body& body) {
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  const RefinedMesh refined = refine_elements(mesh, all_elements(mesh));
  Body fine;
  fine.name = "refined";
  fine.region_names = body.region_names;
  for (int node = 0; node < mesh.nodes(); ++node) {
    fine.nodes.push_back({mesh.X(0, node), mesh.X(1, node), mesh.X(2, node)});
    if (mesh.fixed[to_index(node)]) fine.fixed_nodes.push_back(node);
  }
  for (const Tetrahedron10& t : refined.mesh.tetrahedra)
    fine.tetrahedra.push_back({t[0], t[1], t[2], t[3]});
  fine.tetrahedron_region = refined.mesh.region;
  for (const Facet& f : refined.mesh.facets) fine.boundary.push_back({f[0], f[1], f[2]});
  fine.foundation = refined.mesh.sprung;
  fine.response = body.response;
  return fine;
}

CampaignSettings pressed_by(double radius, double depth) {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.49}}};
  s.indentation.tool.radius = radius;
  s.indentation.depth = depth;
  s.indentation.increments = 4;
  s.indentation.lateral_depths = {depth};
  s.indentation.lateral_travel = 0.5 * depth;
  s.indentation.lateral_increments = 4;
  s.threads = 2;
  return s;
}

SiteCurves press(const Body& body, CampaignSettings settings, int refinements, double x = 0,
                 double y = 0) {
  settings.indentation.refine_under_tool = refinements;
  settings.points = {{{x, y, 0}, {0, 0, -1}}};
  CampaignReport report;
  return run_campaign(body, settings, report).sites.front();
}

double volume(const QuadraticMesh& mesh, const Tetrahedron10& t) {
  const auto edge = [&](std::size_t i) -> Eigen::Vector3d {
    return mesh.X.col(t[i]) - mesh.X.col(t[0]);
  };
  return edge(1).cross(edge(2)).dot(edge(3)) / 6;
}

double area(const QuadraticMesh& mesh) {
  double sum = 0;
  for (const Facet& f : mesh.facets)
    sum += 0.5 * Eigen::Vector3d(mesh.X.col(f[1]) - mesh.X.col(f[0]))
                     .cross(Eigen::Vector3d(mesh.X.col(f[2]) - mesh.X.col(f[0])))
                     .norm();
  return sum;
}

std::vector<int> elements_around(const QuadraticMesh& mesh, double radius) {
  std::vector<int> elements;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e)
    if (std::ranges::any_of(mesh.tetrahedra[to_index(e)],
                            [&](int node) { return mesh.X.col(node).norm() < radius; }))
      elements.push_back(e);
  return elements;
}

/// Each face belongs to two elements or to one and to the boundary, mid-edge nodes are in the
/// middle of their edges, and elements with a common edge have its node in common.
void expect_conforming(const QuadraticMesh& mesh) {
  std::map<std::array<std::int32_t, 3>, int> owners;
  std::map<Edge, std::int32_t> middle_of;
  for (const Tetrahedron10& t : mesh.tetrahedra) {
    EXPECT_GT(volume(mesh, t), 0);
    for (std::size_t without = 0; without < 4; ++without) {
      std::array<std::int32_t, 3> face{};
      for (std::size_t c = 0, i = 0; c < 4; ++c)
        if (c != without) face[i++] = t[c];
      std::sort(face.begin(), face.end());
      ++owners[face];
    }
    for (std::size_t e = 0; e < 6; ++e) {
      const Edge ends = edge_between(t[kTetEdges[e][0]], t[kTetEdges[e][1]]);
      EXPECT_EQ(middle_of.try_emplace(ends, t[4 + e]).first->second, t[4 + e]);
      const Eigen::Vector3d middle = 0.5 * (mesh.X.col(ends[0]) + mesh.X.col(ends[1]));
      EXPECT_LT((mesh.X.col(t[4 + e]) - middle).norm(), 1e-15);
    }
  }
  for (const Facet& f : mesh.facets) {
    std::array<std::int32_t, 3> face{f[0], f[1], f[2]};
    std::sort(face.begin(), face.end());
    EXPECT_EQ(owners[face], 1);
    ++owners[face];
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(middle_of.at(edge_between(f[c], f[(c + 1) % 3])), f[3 + c]);
  }
  for (const auto& [face, count] : owners) EXPECT_EQ(count, 2);
}

TEST(RefinedMesh, IsConformingWithTheSameVolumeAndSurface) {
  const QuadraticMesh whole = make_quadratic_mesh(block_of(6));
  for (const double radius : {0.001, 0.004, 0.009}) {
    const std::vector<int> some = elements_around(whole, radius);
    const RefinedMesh refined = refine_elements(whole, some);
    expect_conforming(refined.mesh);
    EXPECT_GT(refined.mesh.tetrahedra.size(), whole.tetrahedra.size() + 7 * some.size());
    double sum = 0;
    for (const Tetrahedron10& t : refined.mesh.tetrahedra) sum += volume(refined.mesh, t);
    EXPECT_NEAR(sum, 0.03 * 0.03 * 0.015, 1e-12);
    EXPECT_NEAR(area(refined.mesh), area(whole), 1e-12);
  }
  const RefinedMesh all = refine_elements(whole, all_elements(whole));
  expect_conforming(all.mesh);
  EXPECT_EQ(all.mesh.tetrahedra.size(), 8 * whole.tetrahedra.size());
}

/// Children with a corner within `reach` of the origin, half as far at each further level.
ElementChoice within(double reach) {
  return [reach](const std::array<Eigen::Vector3d, 4>& corners, int level) {
    return std::ranges::any_of(corners, [&](const Eigen::Vector3d& x) {
      return x.norm() <= reach * std::pow(0.5, level);
    });
  };
}

double total_volume(const QuadraticMesh& mesh) {
  double sum = 0;
  for (const Tetrahedron10& t : mesh.tetrahedra) sum += volume(mesh, t);
  return sum;
}

/// 1 for the regular tetrahedron, 0 for a flat one.
double worst_shape(const QuadraticMesh& mesh) {
  double worst = 1;
  for (const Tetrahedron10& t : mesh.tetrahedra) {
    double squares = 0;
    for (const auto& [i, j] : kTetEdges)
      squares += (mesh.X.col(t[i]) - mesh.X.col(t[j])).squaredNorm();
    worst = std::min(worst, 12 * std::pow(3 * volume(mesh, t), 2.0 / 3) / squares);
  }
  return worst;
}

TEST(RefinedMesh, IsConformingAtEveryNumberOfLevels) {
  const QuadraticMesh whole = make_quadratic_mesh(block_of(6));
  const std::vector<int> some = elements_around(whole, 0.006);
  std::size_t fewest = whole.tetrahedra.size();
  std::vector<double> shapes;
  for (const int levels : {1, 2, 3, 4, 5}) {
    const RefinedMesh refined = refine_elements(whole, some, levels, within(0.006));
    expect_conforming(refined.mesh);
    EXPECT_NEAR(total_volume(refined.mesh), 0.03 * 0.03 * 0.015, 1e-12);
    EXPECT_NEAR(area(refined.mesh), area(whole), 1e-12);
    EXPECT_GT(refined.mesh.tetrahedra.size(), fewest + 300);
    fewest = refined.mesh.tetrahedra.size();
    shapes.push_back(worst_shape(refined.mesh));
    double smallest = 1;
    for (const Tetrahedron10& t : refined.mesh.tetrahedra)
      smallest = std::min(smallest, (refined.mesh.X.col(t[0]) - refined.mesh.X.col(t[1])).norm());
    EXPECT_NEAR(smallest, 0.005 * std::pow(0.5, levels), 1e-9);
  }
  EXPECT_GT(shapes[4], 0.99 * shapes[1]);  // children of closures are not divided again
}

// Far from what a tool asks for: any child may be divided, beside any that is not.
TEST(RefinedMesh, IsConformingWhateverIsChosen) {
  const QuadraticMesh whole = make_quadratic_mesh(block_of(4));
  for (const std::size_t every : {7U, 23U, 61U}) {
    std::size_t asked = 0;
    const RefinedMesh refined = refine_elements(
        whole, {5, 100, 101}, 4,
        [&](const std::array<Eigen::Vector3d, 4>&, int) { return asked++ % every == 0; });
    expect_conforming(refined.mesh);
    EXPECT_NEAR(total_volume(refined.mesh), 0.03 * 0.03 * 0.015, 1e-12);
    EXPECT_NEAR(area(refined.mesh), area(whole), 1e-12);
  }
}

// A quadratic field is represented by an element and by its children.
TEST(RefinedMesh, ProlongsQuadraticFieldsExactly) {
  const QuadraticMesh whole = make_quadratic_mesh(block_of(4));
  const RefinedMesh refined =
      refine_elements(whole, elements_around(whole, 0.005), 3, within(0.005));
  const auto field = [](const Eigen::Vector3d& X) {
    return 3 + 2 * X[0] - X[2] + 40 * X[0] * X[1] - 7 * X[2] * X[2];
  };
  for (std::size_t i = 0; i < refined.new_nodes.size(); ++i) {
    const RefinedMesh::NewNode& made = refined.new_nodes[i];
    double value = 0;
    for (std::size_t a = 0; a < kTetNodes; ++a)
      value += made.N[a] * field(whole.X.col(whole.tetrahedra[to_index(made.parent)][a]));
    const Eigen::Vector3d X = refined.mesh.X.col(whole.nodes() + static_cast<int>(i));
    EXPECT_NEAR(value, field(X), 1e-12);
  }
}

constexpr double kBend = 10;  // 1/m

double paraboloid(double x, double y) {
  return -kBend * (x * x + y * y);
}

/// A block under a paraboloid, z = -kBend (x^2 + y^2): quadratic over every facet.
Body domed_block(int across) {
  Body body = block_of(across);
  const auto on_top = [&](std::int32_t node) {
    const Vec3& x = body.nodes[to_index(node)];
    return std::abs(x[2] - paraboloid(x[0], x[1])) < 1e-12;
  };
  for (Vec3& x : body.nodes) x[2] += paraboloid(x[0], x[1]);
  for (const Edge& ends : edges_of(body.boundary)) {
    if (!on_top(ends[0]) || !on_top(ends[1])) continue;
    const Vec3 middle = 0.5 * (body.nodes[to_index(ends[0])] + body.nodes[to_index(ends[1])]);
    body.curved_edges.push_back({ends, {middle[0], middle[1], paraboloid(middle[0], middle[1])}});
  }
  return body;
}

// Curved edges make the top the paraboloid itself; the children lie on it, too.
TEST(RefinedMesh, FollowsACurvedSurface) {
  const QuadraticMesh whole = make_quadratic_mesh(domed_block(4));
  const RefinedMesh refined =
      refine_elements(whole, elements_around(whole, 0.005), 3, within(0.005));
  int on_top = 0;
  for (const QuadraticMesh* mesh : {&whole, &refined.mesh})
    for (const Facet& f : mesh->facets) {
      const auto corner_on_top = [&](int node) {
        return std::abs(mesh->X(2, node) - paraboloid(mesh->X(0, node), mesh->X(1, node))) < 1e-12;
      };
      if (!std::all_of(f.begin(), f.begin() + 3, corner_on_top)) continue;
      for (std::size_t m = 3; m < 6; ++m)
        EXPECT_NEAR(mesh->X(2, f[m]), paraboloid(mesh->X(0, f[m]), mesh->X(1, f[m])), 1e-15);
      ++on_top;
    }
  EXPECT_GT(on_top, 2 * 2 * 4 * 4);
}

TEST(RefinedMesh, RefusesAnElementThatACurvedEdgeInverts) {
  Body body = domed_block(4);
  for (CurvedEdge& edge : body.curved_edges) edge.middle[2] -= 0.02;
  const QuadraticMesh whole = make_quadratic_mesh(body);
  try {
    refine_elements(whole, all_elements(whole));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("invert"));
  }
}

// A tool as large as the body: the site refines every element.
TEST(RefineUnderTool, IsTheRefinedBodyWhereTheToolSpansItAll) {
  const Body coarse = block_of(4), fine = refined_body(coarse);
  CampaignSettings settings = pressed_by(0.027, 0.003);
  for (const Dilatation element : {Dilatation::Mean, Dilatation::Nodal}) {
    settings.dilatation = element;
    const SiteCurves ours = press(coarse, settings, 1), reference = press(fine, settings, 0);
    ASSERT_EQ(ours.status, SiteStatus::Complete) << ours.reason;
    ASSERT_EQ(ours.paths.size(), 2u);
    for (std::size_t p = 0; p < 2; ++p)
      for (std::size_t i = 1; i < ours.paths[p].samples.size(); ++i) {
        const CurveSample &a = ours.paths[p].samples[i], &b = reference.paths[p].samples[i];
        EXPECT_LT(norm(a.force - b.force), 5e-4 * norm(b.force)) << name_of(element);
        EXPECT_NEAR(a.strain_energy, b.strain_energy, 1e-3 * b.strain_energy);
      }
  }
}

/// The block with springs at its base in place of the support.
Body block_on_springs(int across, double stiffness) {
  Body body = block_of(across);
  body.fixed_nodes.clear();
  for (std::size_t f = 0; f < body.boundary.size(); ++f)
    if (std::ranges::all_of(body.boundary[f],
                            [&](int node) { return body.nodes[to_index(node)][2] < -0.0149; }))
      body.foundation.push_back({static_cast<std::int32_t>(f), stiffness, 0.5 * stiffness});
  return body;
}

// The same of bodies that sag by 1 to 2 mm, without friction as the press and the drag of others.
TEST(RefineUnderTool, OnSpringsAndUnderWeightIsTheRefinedBody) {
  constexpr double kSprings = 4e5;
  const Gravity oblique{{0, 15, -40}, 1000};
  struct Support {
    Body body;
    Gravity gravity;
  };
  for (const Support& support :
       {Support{block_of(4), oblique}, Support{block_on_springs(4, kSprings), {}},
        Support{block_on_springs(4, kSprings), oblique}}) {
    CampaignSettings settings = pressed_by(0.027, 0.003);
    settings.gravity = support.gravity;
    const SiteCurves ours = press(support.body, settings, 1),
                     reference = press(refined_body(support.body), settings, 0);
    ASSERT_EQ(ours.status, SiteStatus::Complete) << ours.reason;
    ASSERT_EQ(ours.paths.size(), 2u);
    for (std::size_t p = 0; p < 2; ++p)
      for (std::size_t i = 1; i < ours.paths[p].samples.size(); ++i) {
        const CurveSample &a = ours.paths[p].samples[i], &b = reference.paths[p].samples[i];
        EXPECT_LT(norm(a.force - b.force), 5e-4 * norm(b.force));
        EXPECT_NEAR(a.strain_energy, b.strain_energy, 1e-3 * b.strain_energy);
        EXPECT_NEAR(a.volume_change, b.volume_change, 1e-3 * std::abs(b.volume_change) + 1e-12);
      }
  }
}

// The elements of the case carry a weight under which those of half the size buckle.
TEST(RefineUnderTool, FailsWithAReasonWhereSmallerElementsBuckleUnderTheWeight) {
  const Body body = block_on_springs(4, 4e5);
  CampaignSettings settings = pressed_by(0.027, 0.003);
  settings.gravity = {{0, 33.2, -83}, 1000};
  settings.indentation.increments = 2;
  settings.indentation.lateral_depths.clear();
  EXPECT_EQ(press(body, settings, 0).status, SiteStatus::Complete);
  const SiteCurves refined = press(body, settings, 1);
  EXPECT_EQ(refined.status, SiteStatus::Failed);
  EXPECT_THAT(refined.reason, HasSubstr("under its weight, before the touch: "));
  ASSERT_EQ(refined.paths.size(), 1u);
  EXPECT_EQ(refined.paths[0].samples.size(), 1u);
}

TEST(RefineUnderTool, ByContactTheWorkOnABodyThatSagsIsItsEnergy) {
  CampaignSettings settings = pressed_by(0.005, 0.0012);
  settings.gravity = {{0, 15, -40}, 1000};
  const SiteCurves site =
      press(block_on_springs(4, 4e5), settings, IndentationSettings::kByContact, 0.0012, 0.0021);
  ASSERT_EQ(site.status, SiteStatus::Complete) << site.reason;
  EXPECT_EQ(site.paths[0].samples.front().strain_energy, 0);
  for (const CurvePath& path : site.paths) {
    const CurveSample& end = path.samples.back();
    EXPECT_NEAR(end.strain_energy + end.contact_energy, end.tool_work, 0.005 * end.tool_work);
  }
}

// A contact smaller than a facet, beside the nodes.
TEST(RefineUnderTool, HasTheForcesOfTheRefinedBodyInSmallContacts) {
  const Body coarse = block_of(6), fine = refined_body(coarse);
  const CampaignSettings settings = pressed_by(0.004, 0.0016);
  const double x = 0.0012, y = 0.0021;
  const SiteCurves ours = press(coarse, settings, 1, x, y),
                   reference = press(fine, settings, 0, x, y),
                   unrefined = press(coarse, settings, 0, x, y);
  ASSERT_EQ(ours.status, SiteStatus::Complete) << ours.reason;
  for (std::size_t i = 1; i < reference.paths[0].samples.size(); ++i) {
    const Vec3& exact = reference.paths[0].samples[i].force;
    EXPECT_LT(norm(ours.paths[0].samples[i].force - exact), 0.01 * norm(exact));
  }
  const Vec3& first = reference.paths[0].samples[1].force;
  EXPECT_GT(norm(unrefined.paths[0].samples[1].force - first), 0.05 * norm(first));
}

// A contact of a third of a facet.
TEST(RefineUnderTool, TwiceHasTheForcesOfTheBodyRefinedTwice) {
  const Body coarse = block_of(4), fine = refined_body(refined_body(coarse));
  CampaignSettings settings = pressed_by(0.005, 0.0012);
  settings.indentation.lateral_depths.clear();
  const double x = 0.0012, y = 0.0021;
  const SiteCurves once = press(coarse, settings, 1, x, y),
                   twice = press(coarse, settings, 2, x, y),
                   reference = press(fine, settings, 0, x, y);
  ASSERT_EQ(twice.status, SiteStatus::Complete) << twice.reason;
  for (std::size_t i = 1; i < reference.paths[0].samples.size(); ++i) {
    const Vec3& exact = reference.paths[0].samples[i].force;
    EXPECT_LT(norm(twice.paths[0].samples[i].force - exact), 0.015 * norm(exact)) << i;
  }
  const Vec3& first = reference.paths[0].samples[1].force;
  EXPECT_GT(norm(once.paths[0].samples[1].force - first), 0.03 * norm(first));
}

/// The force at a sample of the normal path.
double force_at(const SiteCurves& site, std::size_t sample) {
  return norm(site.paths[0].samples[sample].force);
}

// Facets larger than the tool, contacts from a sixth of a facet on, in different parts of facets.
TEST(RefineUnderTool, ByContactTheForceDoesNotDependOnTheFacets) {
  const Body coarse = block_of(4), fine = refined_body(refined_body(coarse));
  CampaignSettings settings = pressed_by(0.005, 0.0012);
  const double x = 0.0012, y = 0.0021;
  const int by_contact = IndentationSettings::kByContact;
  const SiteCurves ours = press(coarse, settings, by_contact, x, y);
  ASSERT_EQ(ours.status, SiteStatus::Complete) << ours.reason;
  for (const CurvePath& path : ours.paths) {
    const CurveSample& end = path.samples.back();
    EXPECT_NEAR(end.strain_energy + end.contact_energy, end.tool_work, 0.005 * end.tool_work);
  }
  settings.indentation.lateral_depths.clear();
  const SiteCurves beside = press(coarse, settings, by_contact, 0.0005, 0.0003),
                   unrefined = press(coarse, settings, 0, x, y),
                   reference = press(fine, settings, 0, x, y);
  for (std::size_t i = 1; i < ours.paths[0].samples.size(); ++i) {
    EXPECT_NEAR(force_at(beside, i), force_at(ours, i), 0.02 * force_at(ours, i)) << i;
    // The elements of the reference are larger than its first contact.
    const double allowed = (i > 1 ? 0.02 : 0.04) * force_at(ours, i);
    EXPECT_NEAR(force_at(ours, i), force_at(reference, i), allowed) << i;
  }
  EXPECT_GT(std::abs(force_at(unrefined, 1) - force_at(ours, 1)), 0.1 * force_at(ours, 1));
}

/// Largest relative difference of the normal forces of two presses.
double difference(const SiteCurves& a, const SiteCurves& b) {
  double largest = 0;
  for (std::size_t i = 1; i < a.paths[0].samples.size(); ++i)
    largest = std::max(largest, std::abs(force_at(a, i) / force_at(b, i) - 1));
  return largest;
}

// The same on facets larger than the fillet of a disc, and than the contact of a cylinder.
TEST(RefineUnderTool, ByContactOtherToolsDoNotFeelTheFacets) {
  const Body coarse = block_of(4);
  for (const ToolGeometry& tool : {ToolGeometry{ToolShape::Disc, 0.004, 0.0015, 0},
                                   ToolGeometry{ToolShape::Cylinder, 0.003, 0, 0.006}}) {
    CampaignSettings settings = pressed_by(0.005, 0.0012);
    settings.indentation.tool = tool;
    settings.indentation.size_over_contact = 2;  // fine enough for this, in a fraction of the time
    settings.indentation.increments = 2;
    settings.indentation.lateral_depths.clear();
    const auto at = [&](int refinements, double x, double y) {
      return press(coarse, settings, refinements, x, y);
    };
    const int by_contact = IndentationSettings::kByContact;
    const SiteCurves ours = at(by_contact, 0.0012, 0.0021), beside = at(by_contact, 0, 0);
    ASSERT_EQ(ours.status, SiteStatus::Complete) << ours.reason;
    EXPECT_LT(difference(ours, beside), 0.03) << name_of(tool.shape);
    EXPECT_GT(difference(at(0, 0.0012, 0.0021), ours), 0.06) << name_of(tool.shape);
  }
}

TEST(RefineUnderTool, ConservesEnergyBetweenSmallAndLargeElements) {
  const SiteCurves site = press(block_of(6), pressed_by(0.005, 0.003), 1, 0.0012, 0.0021);
  ASSERT_EQ(site.status, SiteStatus::Complete) << site.reason;
  for (const CurvePath& path : site.paths) {
    const CurveSample& end = path.samples.back();
    EXPECT_NEAR(end.strain_energy + end.contact_energy, end.tool_work, 0.005 * end.tool_work);
  }
}

TEST(RefineUnderTool, IsRefusedWithLinearDisplacements) {
  const Body body = block_of(4);
  CampaignSettings settings = pressed_by(0.005, 0.002);
  settings.dilatation = Dilatation::LinearNodal;
  try {
    press(body, settings, 1);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("refined"));
  }
}

}  // namespace
}  // namespace palpate::fem
