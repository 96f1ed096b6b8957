// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/site_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::fitting {
namespace {

SiteCurves site_with_two_paths() {
  SiteCurves site;
  CurvePath normal{PathKind::Normal, 0, {0, 0, -1}, {}};
  CurvePath lateral{PathKind::Lateral, 0.002, {1, 0, 0}, {}};
  for (int i = 0; i <= 3; ++i) {
    CurveSample sample;
    sample.displacement = 0.001 * i;
    sample.force = {0.5, 0.25, -200 * sample.displacement};
    normal.samples.push_back(sample);
    sample.force = {0.5 + 60 * sample.displacement, 0.25, -0.4};
    lateral.samples.push_back(sample);
  }
  site.paths = {normal, lateral};
  return site;
}

TEST(SiteSamples, NormalSamplesAreTheForceAlongThePath) {
  const auto samples = normal_samples(site_with_two_paths());
  ASSERT_EQ(samples.size(), 3u);  // the response is zero at zero
  for (const ForceSample& sample : samples)
    EXPECT_NEAR(sample.force, 200 * sample.displacement, 1e-15);
  EXPECT_DOUBLE_EQ(normal_reach(site_with_two_paths()), 0.003);
  EXPECT_EQ(normal_reach(SiteCurves{}), 0);
}

TEST(SiteSamples, LateralSamplesAreTheRiseOfTheForceAlongThePath) {
  const auto paths = lateral_paths(site_with_two_paths());
  ASSERT_EQ(paths.size(), 1u);
  ASSERT_EQ(paths[0].size(), 3u);
  for (const ForceSample& sample : paths[0])
    EXPECT_NEAR(sample.force, 60 * sample.displacement, 1e-15);
}

/// A body that stores E = 100 d^2 along the press, and 30 r^2 + 0.5 r along a lateral path that
/// starts with a force of 0.5 N.
SiteCurves site_with_energies() {
  SiteCurves site = site_with_two_paths();
  for (CurvePath& path : site.paths)
    for (CurveSample& sample : path.samples) {
      const double d = sample.displacement;
      const bool normal = path.kind == PathKind::Normal;
      sample.contact_energy = 1e-3 * d;
      sample.strain_energy = (normal ? 100 * d * d : 0.7 + 30 * d * d + 0.5 * d) - 1e-3 * d;
    }
  return site;
}

TEST(SiteSamples, MeansOfTheForceAreTheStoredEnergyOverTheTravel) {
  const SiteCurves site = site_with_energies();
  const auto expect_linear = [](const std::vector<ForceSample>& samples, double stiffness) {
    ASSERT_EQ(samples.size(), 3u);
    for (const ForceSample& sample : samples) {
      EXPECT_NEAR(sample.since, sample.displacement - 0.001, 1e-15);
      EXPECT_NEAR(sample.mean, stiffness * (sample.displacement - 0.0005), 1e-12);
    }
  };
  expect_linear(normal_samples(site), 200);
  expect_linear(lateral_paths(site)[0], 60);
  expect_linear(mean_lateral(lateral_paths(site)), 60);
}

/// The lateral mean goes on with the rise of the longer path, and so does the mean of its force.
TEST(SiteSamples, MeansOfPathsOfDifferentLengthAreThoseOfTheirRise) {
  const std::vector<ForceSample> small{{0.001, 0.04, 0.02, 0}, {0.002, 0.08, 0.06, 0.001}},
      large{{0.001, 0.08, 0.04, 0}, {0.002, 0.16, 0.12, 0.001}, {0.003, 0.24, 0.2, 0.002}};
  const auto mean = mean_lateral({small, large});
  ASSERT_EQ(mean.size(), 3u);
  EXPECT_NEAR(mean[0].mean, 0.03, 1e-15);
  EXPECT_NEAR(mean[1].mean, 0.09, 1e-15);
  EXPECT_NEAR(mean[2].mean, 0.12 + 0.04, 1e-15);
}

/// A snap loses a part of the work, and the force on the way cannot be had from what is stored.
TEST(SiteSamples, WhereTheBodySnapsTheMeanIsUnknown) {
  SiteCurves site = site_with_energies();
  auto& press = site.paths[0].samples;
  for (CurveSample& sample : press) sample.tool_work = sample.strain_energy + sample.contact_energy;
  const double lost = 0.3 * (press[2].tool_work - press[1].tool_work);
  for (const std::size_t i : {2u, 3u}) press[i].strain_energy -= lost;
  const auto samples = normal_samples(site);
  EXPECT_NEAR(samples[0].mean, 200 * 0.0005, 1e-12);
  EXPECT_TRUE(std::isnan(samples[1].mean));
  EXPECT_NEAR(samples[2].mean, 200 * 0.0025, 1e-12);
}

/// A measured path knows no energy, and curves of before have none of the contact.
TEST(SiteSamples, WithoutEnergiesTheMeansAreUnknown) {
  for (const ForceSample& sample : normal_samples(site_with_two_paths()))
    EXPECT_TRUE(std::isnan(sample.mean));
  for (const ForceSample& sample : mean_lateral(lateral_paths(site_with_two_paths())))
    EXPECT_TRUE(std::isnan(sample.mean));
}

TEST(SiteSamples, TheMeanOfEqualPathsIsThePath) {
  const std::vector<ForceSample> path{{0.001, 0.05}, {0.002, 0.12}, {0.004, 0.2}};
  const auto mean = mean_lateral({path, path, path});
  ASSERT_EQ(mean.size(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_DOUBLE_EQ(mean[i].displacement, path[i].displacement);
    EXPECT_NEAR(mean[i].force, path[i].force, 1e-15);
  }
}

TEST(SiteSamples, AShortLateralPathDoesNotMakeTheMeanJump) {
  const auto samples =
      mean_lateral({{{0.001, 0.04}, {0.002, 0.08}}, {{0.001, 0.08}, {0.002, 0.16}, {0.003, 0.24}}});
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_NEAR(samples[1].force, 0.12, 1e-12);
  EXPECT_NEAR(samples[2].force, 0.12 + 0.08, 1e-12);  // continues with the slope of the longer one
}

TEST(SiteSamples, OfEveryDepthLeaveOutADirectionThatIsDraggedAtOneOnly) {
  SiteCurves site;
  const auto add = [&](double depth, const Vec3& direction) {
    site.paths.push_back({PathKind::Lateral, depth, direction, {}});
  };
  site.paths.push_back({PathKind::Normal, 0, {0, 0, -1}, {}});
  add(0.001, {1, 0, 0});
  add(0.002, {1, 0, 0});
  add(0.002, {0, 1, 0});
  EXPECT_EQ(at_every_depth(site).paths.size(), 2u);
  EXPECT_EQ(paths_at(site, 0.002).paths.size(), 2u);
  add(0.001, {0, 1, 0});
  EXPECT_EQ(at_every_depth(site).paths.size(), 4u);
  // Where no direction recurs, all stand for the site.
  site.paths.erase(site.paths.begin() + 2);
  site.paths.pop_back();
  EXPECT_EQ(at_every_depth(site).paths.size(), site.paths.size());
}

}  // namespace
}  // namespace palpate::fitting
