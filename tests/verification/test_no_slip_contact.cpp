// SPDX-License-Identifier: AGPL-3.0-or-later
// No-slip contact: the lateral stiffness of a sphere, and the balance of energy of every path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>

#include "fem/campaign/indentation.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/verification/record.hpp"

namespace palpate::fem {
namespace {

constexpr double kYoung = 10e3;

double force_at(const CurvePath& path, double depth) {
  for (const CurveSample& sample : path.samples)
    if (std::abs(sample.displacement - depth) < 1e-9 * depth)
      return dot(sample.force, path.direction);
  return std::nan("");
}

/// Lateral over normal stiffness of a sphere pressed to the depth at which its contact is a circle
/// of 1 mm radius, then moved sideways without slip: the mean over two directions and a number of
/// positions on a mesh of this element size.
double lateral_over_normal(double element, double poisson, int positions) {
  const double a = 1e-3, radius = 10 * a, depth = a * a / radius;
  const Body body = test::graded_block(25 * a, 2.2 * a, element, 1.8);
  CampaignSettings settings;
  settings.materials = {{"tissue", {kYoung, poisson}}};
  settings.indentation.tool.radius = radius;
  settings.indentation.depth = 1.1 * depth;
  settings.indentation.increments = 1;
  settings.indentation.lateral_depths = {0.9 * depth, depth};
  settings.indentation.lateral_travel = 0.02 * depth;
  settings.indentation.lateral_increments = 1;
  settings.indentation.azimuths = {0, M_PI / 2};
  settings.indentation.force_tolerance = 3e-5;
  for (int i = 0; i < positions; ++i)  // spread over a cell of the mesh
    settings.points.push_back(
        {{element * (i + 0.5) / positions, element * std::fmod(0.618 * i + 0.3, 1.0), 0},
         {0, 0, -1}});
  const CampaignContext context(body, settings, Engine::SharedFactor);
  double sum = 0;
  int count = 0;
  for (int i = 0; i < positions; ++i) {
    const SiteCurves curves = solve_site(context, i, nullptr);
    EXPECT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
    const CurvePath& pressed = curves.paths.front();
    const double normal =
        (force_at(pressed, 1.1 * depth) - force_at(pressed, 0.9 * depth)) / (0.2 * depth);
    for (const CurvePath& path : curves.paths) {
      if (path.kind != PathKind::Lateral || path.lateral_depth < 0.95 * depth) continue;
      const Vec3 change = path.samples.back().force - path.samples.front().force;
      sum += dot(change, path.direction) / settings.indentation.lateral_travel / normal;
      ++count;
    }
  }
  return sum / count;
}

struct MindlinCase {
  double poisson, element, bound;
};

void PrintTo(const MindlinCase& c, std::ostream* out) {
  *out << "nu " << c.poisson << ", elements of " << 1e3 * c.element << " mm";
}

class Mindlin : public testing::TestWithParam<MindlinCase> {};

/// k_t/k_n = 2(1 - nu)/(2 - nu) [Mindlin 1949] for every contact radius. The factor of the tie
/// stiffness was chosen to meet these values: the test detects changes and verifies nothing.
TEST_P(Mindlin, LateralStiffnessOfASphereIsAsCalibrated) {
  const auto [poisson, element, bound] = GetParam();
  const double exact = 2 * (1 - poisson) / (2 - poisson);
  const double ratio = lateral_over_normal(element, poisson, 3);
  char name[96];
  std::snprintf(name, sizeof name,
                "lateral over normal stiffness, nu = %.2f, %.1f elements per contact radius",
                poisson, 1e-3 / element);
  test::verify({"Sphere in no-slip contact with a half-space, moved sideways, mean over positions",
                name, "1", ratio, exact, test::Reference::Calibration,
                "Mindlin 1949, to which the tie stiffness was fitted", bound});
}

INSTANTIATE_TEST_SUITE_P(Meshes, Mindlin,
                         testing::Values(MindlinCase{0.3, 0.7e-3, 0.02},
                                         MindlinCase{0.49, 1.4e-3, 0.06}));

struct BalanceCase {
  ToolGeometry tool;
  ToolFriction friction;
};

std::string text(const BalanceCase& c) {
  return name_of(c.tool.shape) + (c.tool.edge_radius > 0 ? " of rounded edge, " : ", ") +
         name_of(c.friction) + " while pressed";
}

void PrintTo(const BalanceCase& c, std::ostream* out) {
  *out << text(c);
}

class Balance : public testing::TestWithParam<BalanceCase> {};

/// Elements nearly as large as the tool, so that facets are in contact in part; deep presses in
/// increments of a fifth of the tool, and lateral paths from the first of them on.
TEST_P(Balance, WorkOfTheToolIsTheStoredEnergy) {
  const auto across = test::even(-0.03, 0.03, 15);
  const Body body =
      test::make_block(across, across, {-0.03, -0.022, -0.015, -0.01, -0.006, -0.003, 0});
  CampaignSettings settings;
  settings.materials = {{"tissue", {kYoung, 0.49}}};
  settings.indentation.tool = GetParam().tool;
  settings.indentation.friction = GetParam().friction;
  settings.indentation.depth = 0.005;
  settings.indentation.increments = 5;
  // At 1e-4 the residual would change the balance by as much as the integration error.
  settings.indentation.force_tolerance = 1e-6;
  settings.indentation.lateral_depths = {0.001, 0.003, 0.005};
  settings.indentation.lateral_travel = 0.003;
  settings.indentation.lateral_increments = 3;
  settings.indentation.azimuths = {0.0, 2.2};
  settings.points = {{{0.0027, 0.0013, 0}, {0, 0, -1}}};
  const CampaignContext context(body, settings, Engine::SharedFactor);
  const SiteCurves curves = solve_site(context, 0, nullptr);
  ASSERT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
  ASSERT_EQ(curves.paths.size(), 7u);
  double worst[2] = {0, 0};
  for (const CurvePath& path : curves.paths) {
    const CurveSample& end = path.samples.back();
    const double stored = end.strain_energy + end.contact_energy;
    double& largest = worst[path.kind == PathKind::Lateral ? 1 : 0];
    largest = std::max(largest, std::abs(end.tool_work / stored - 1));
  }
  const char* problem =
      "Balance of energy: |work of the tool over stored energy - 1|, elements of 4 mm, increments "
      "of 1 mm";
  test::verify({problem, text(GetParam()) + ", 5 mm deep", "1", worst[0], 0,
                test::Reference::Theory, "conservation of energy", 0.005, test::Error::Absolute});
  test::verify({problem, text(GetParam()) + ", worst of six lateral paths of 3 mm", "1", worst[1],
                0, test::Reference::Theory, "conservation of energy", 0.005,
                test::Error::Absolute});
}

constexpr ToolGeometry kSphere{ToolShape::Sphere, 0.005, 0, 0},
    kSharpDisc{ToolShape::Disc, 0.005, 0, 0}, kRoundedDisc{ToolShape::Disc, 0.005, 0.001, 0},
    kCylinder{ToolShape::Cylinder, 0.004, 0, 0.006};

INSTANTIATE_TEST_SUITE_P(Tools, Balance,
                         testing::Values(BalanceCase{kSphere, ToolFriction::Frictionless},
                                         BalanceCase{kSphere, ToolFriction::NoSlip},
                                         BalanceCase{kSharpDisc, ToolFriction::NoSlip},
                                         BalanceCase{kRoundedDisc, ToolFriction::Frictionless},
                                         BalanceCase{kCylinder, ToolFriction::Frictionless},
                                         BalanceCase{kCylinder, ToolFriction::NoSlip}));

}  // namespace
}  // namespace palpate::fem
