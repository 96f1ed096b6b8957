// SPDX-License-Identifier: AGPL-3.0-or-later
// The error of the mesh of all sites from the differences at a few of them.
#include "fitting/response/mesh_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "format/numbers.hpp"

namespace palpate::fitting {
namespace {

/// One normal path with these forces, differences and facets in contact.
SiteCurves site_of(std::int32_t vertex, const std::vector<double>& force,
                   const std::vector<double>& difference, double facets) {
  SiteCurves site;
  site.vertex = vertex;
  site.status = SiteStatus::Complete;
  CurvePath path;
  path.direction = {0, 0, -1};
  path.samples.emplace_back();
  for (std::size_t i = 0; i < force.size(); ++i) {
    CurveSample sample;
    sample.displacement = 1e-3 * static_cast<double>(i + 1);
    sample.force = {0, 0, -force[i]};
    sample.facets_in_contact = facets;
    if (!difference.empty()) sample.mesh_difference = difference[i];
    path.samples.push_back(sample);
  }
  site.paths.push_back(path);
  return site;
}

double relative_error(const SiteCurves& site, std::size_t sample) {
  const CurveSample& s = site.paths[0].samples[sample];
  return s.mesh_error / norm(s.force);
}

TEST(MeshError, IsTheLargestDifferenceAtTheNearestResolution) {
  // 20 differences of 1 to 20 % where the contact covers a facet, 20 of 1 % where it covers ten.
  const std::vector<double> force(20, 2.0), small(20, 0.02);
  std::vector<double> growing;
  for (int i = 1; i <= 20; ++i) growing.push_back((i % 2 == 0 ? 0.02 : -0.02) * i);
  Curves curves;
  curves.sites = {site_of(0, force, growing, 1), site_of(1, force, small, 10),
                  site_of(2, force, {}, 0.9), site_of(3, force, {}, 12)};
  bound_mesh_errors(curves);
  // 19 of the 20 differences are taken, which may leave out the largest.
  EXPECT_NEAR(relative_error(curves.sites[2], 5), 0.2, 0.0101);
  EXPECT_NEAR(relative_error(curves.sites[3], 5), 0.01, 1e-12);
  EXPECT_EQ(curves.sites[3].paths[0].samples.front().mesh_error, 0);
  EXPECT_DOUBLE_EQ(curves.mesh_error_confidence, 0.95);
  const MeshErrorSummary summary = mesh_error_summary(curves);
  EXPECT_NEAR(summary.worst_at_end, 0.2, 0.0101);
}

/// A lateral path of a site, whose force begins with that of the press.
CurvePath lateral_path(double difference) {
  CurvePath path{PathKind::Lateral, 1e-3, {1, 0, 0}, {}};
  for (int i = 0; i < 4; ++i) {
    CurveSample sample;
    sample.displacement = 1e-3 * i;
    sample.force = {0.1 + 0.5 * i, 0, -2};
    sample.facets_in_contact = 3;
    if (i > 0) sample.mesh_difference = difference * 0.5 * i;
    path.samples.push_back(sample);
  }
  return path;
}

/// Each kind by its own differences, relative to the force since the start of the path.
TEST(MeshError, OfLateralPathsIsThatOfLateralDifferences) {
  Curves curves;
  curves.sites = {site_of(0, {2, 2}, {0.02, 0.02}, 3), site_of(1, {2, 2}, {}, 3)};
  curves.sites[0].paths.push_back(lateral_path(0.06));
  curves.sites[1].paths.push_back(lateral_path(kUnknown));
  bound_mesh_errors(curves);
  EXPECT_NEAR(relative_error(curves.sites[1], 2), 0.01, 1e-12);
  const auto& lateral = curves.sites[1].paths[1].samples;
  EXPECT_EQ(lateral[0].mesh_error, 0);
  EXPECT_NEAR(lateral[3].mesh_error, 0.06 * 1.5, 1e-12);
  EXPECT_NEAR(mesh_error_summary(curves, PathKind::Lateral).worst_at_end, 0.06, 1e-12);
  EXPECT_NEAR(mesh_error_summary(curves).worst_at_end, 0.01, 1e-12);
  EXPECT_NEAR(curves.mesh_error_confidence, 2.0 / 3, 1e-12);
}

/// A press at a sharp edge errs ten times as much, at the resolution of a site elsewhere too.
TEST(MeshError, AtSharpEdgesIsThatOfSitesThere) {
  const std::vector<double> force(20, 2.0), large(20, 0.4), small(20, 0.04);
  Curves curves;
  curves.sites = {site_of(0, force, large, 1), site_of(1, force, small, 10),
                  site_of(2, force, {}, 1), site_of(3, force, {}, 1)};
  bound_mesh_errors(curves, {true, false, true, false});
  EXPECT_NEAR(relative_error(curves.sites[2], 5), 0.2, 1e-12);
  EXPECT_NEAR(relative_error(curves.sites[3], 5), 0.02, 1e-12);
  EXPECT_DOUBLE_EQ(curves.mesh_error_confidence, 0.95);
  // No site at an edge was pressed twice: those of all are the best that is known.
  bound_mesh_errors(curves, {false, false, true, false});
  EXPECT_NEAR(relative_error(curves.sites[2], 5), 0.2, 1e-12);
  EXPECT_EQ(curves.mesh_error_confidence, 0);
}

TEST(MeshError, OfFewDifferencesHasALowerConfidence) {
  Curves curves;
  curves.sites = {site_of(0, {1, 1, 1}, {0.1, -0.3, 0.2}, 1), site_of(1, {1, 1, 1}, {}, 5)};
  bound_mesh_errors(curves);
  EXPECT_DOUBLE_EQ(relative_error(curves.sites[1], 3), 0.3);
  EXPECT_DOUBLE_EQ(curves.mesh_error_confidence, 0.75);
}

TEST(MeshError, StaysUnknownWithoutDifferences) {
  Curves curves;
  curves.sites = {site_of(0, {1, 2}, {}, 1)};
  bound_mesh_errors(curves);
  EXPECT_TRUE(std::isnan(curves.sites[0].paths[0].samples[1].mesh_error));
  EXPECT_TRUE(std::isnan(curves.mesh_error_confidence));
  EXPECT_TRUE(std::isnan(mesh_error_summary(curves).median_at_end));
}

}  // namespace
}  // namespace palpate::fitting
