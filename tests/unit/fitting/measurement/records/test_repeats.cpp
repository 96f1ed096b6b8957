// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/repeats.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/records/bench.hpp"

namespace palpate::measured {
namespace {

using testing::HasSubstr;

const Vec3 kInward{0, 0, -1};

std::vector<PressCurve> presses_of_site(int count, double scatter_of_modulus, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<PressCurve> presses;
  for (int i = 0; i < count; ++i) {
    Bench bench;
    bench.modulus *= 1 + scatter_of_modulus * normal(engine);
    presses.push_back(analyse_press(press_on(bench, seed + static_cast<unsigned>(i)), {}));
  }
  return presses;
}

/// The path is the record a simulation would give: from the touch, along inward, work and all.
TEST(Repeats, AreTheRecordOfASimulatedCurve) {
  const Bench bench;
  const CurvePath path = mean_path(presses_of_site(3, 0, 21), kInward, {}, "site");
  EXPECT_EQ(path.kind, PathKind::Normal);
  EXPECT_EQ(path.repeats, 3);
  ASSERT_EQ(path.samples.size(), 25U);
  EXPECT_EQ(path.samples.front().displacement, 0);
  EXPECT_EQ(norm(path.samples.front().force), 0);
  for (const CurveSample& sample : path.samples) {
    const double wanted = sneddon_force(sample.displacement, bench.radius, bench.modulus);
    EXPECT_NEAR(-sample.force[2], wanted, 4 * sample.force_uncertainty + 1e-9);
    EXPECT_EQ(sample.force[0], 0);
    EXPECT_TRUE(std::isnan(sample.strain_energy));
  }
  // Work: the closed form integrated over the depth.
  double work = 0;
  const double reach = path.samples.back().displacement;
  for (int i = 0; i < 1000; ++i) {
    work += sneddon_force(reach * (i + 0.5) / 1000, bench.radius, bench.modulus) * reach / 1000;
  }
  EXPECT_NEAR(path.samples.back().tool_work, work, 0.01 * work);
}

TEST(Repeats, ScatterIsThatOfTheSpecimens) {
  const auto presses = presses_of_site(40, 0.1, 31);
  const CurvePath path = mean_path(presses, kInward, {}, "site");
  const CurveSample& end = path.samples.back();
  const double relative = end.force_scatter / norm(end.force);
  EXPECT_NEAR(relative, 0.1, 0.035);  // three standard deviations of the scatter of forty
  EXPECT_NEAR(end.force_uncertainty, end.force_scatter / std::sqrt(40.0),
              0.05 * end.force_uncertainty);
}

/// One file of the repeats in another unit of length.
TEST(Repeats, RefusesPressesOfOtherDepths) {
  std::vector<PressCurve> presses = presses_of_site(2, 0, 61);
  for (DepthForce& sample : presses[1].loading) sample.depth *= 1000;
  try {
    mean_path(presses, kInward, {}, "site 4");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("check their units of length"));
  }
}

TEST(Repeats, OnePressHasNoScatterButAnUncertainty) {
  const CurvePath path = mean_path(presses_of_site(1, 0, 41), kInward, {}, "site");
  EXPECT_TRUE(std::isnan(path.samples.back().force_scatter));
  EXPECT_GT(path.samples.back().force_uncertainty, 0);
  EXPECT_GT(path.contact_uncertainty, 0);
}

/// A record that begins in contact has no samples above its beginning, and no made-up ones.
TEST(Repeats, BeginWhereTheRecordsBegin) {
  std::vector<PressCurve> presses = presses_of_site(2, 0, 43);
  const CurvePath whole = mean_path(presses, kInward, {}, "site");
  const double begin = 0.3 * whole.samples.back().displacement;
  std::erase_if(presses[1].loading, [&](const DepthForce& s) { return s.depth < begin; });
  const CurvePath path = mean_path(presses, kInward, {}, "site");
  EXPECT_EQ(path.samples.front().displacement, 0);
  EXPECT_GE(path.samples[1].displacement, begin);
  EXPECT_LT(path.samples[1].displacement, begin + 2 * whole.samples[1].displacement);
  EXPECT_NEAR(norm(path.samples.back().force), norm(whole.samples.back().force),
              0.02 * norm(whole.samples.back().force));
}

/// A record that was sampled slowly has a curve of fewer samples, and the same force.
TEST(Repeats, AreAsFineAsTheRecordsAllow) {
  std::vector<PressCurve> presses = presses_of_site(1, 0, 44);
  const CurvePath fine = mean_path(presses, kInward, {}, "site");
  std::vector<DepthForce>& loading = presses[0].loading;
  std::vector<DepthForce> few;
  for (std::size_t i = 0; i < 30; ++i) few.push_back(loading[(loading.size() - 1) * (i + 1) / 30]);
  loading = few;
  const CurvePath coarse = mean_path(presses, kInward, {}, "site");
  EXPECT_LT(coarse.samples.size(), 20U);
  EXPECT_GT(coarse.samples.size(), 10U);
  EXPECT_NEAR(norm(coarse.samples.back().force), norm(fine.samples.back().force),
              0.02 * norm(fine.samples.back().force));
}

/// Calibration of the load cell and compliance act on all presses alike: more presses do not help.
TEST(Repeats, CommonUncertaintiesDoNotAverageOut) {
  RepeatSettings settings;
  settings.force_calibration = 0.02;
  const CurvePath path = mean_path(presses_of_site(30, 0, 51), kInward, settings, "site");
  const CurveSample& end = path.samples.back();
  EXPECT_GE(end.force_uncertainty, 0.02 * norm(end.force));
  EXPECT_LT(end.force_uncertainty, 0.03 * norm(end.force));
}

/// The uncertainty of a mean of few presses covers the truth at all depths.
TEST(Repeats, UncertaintyCoversTheTruth) {
  int inside = 0, total = 0;
  const Bench bench;
  for (unsigned trial = 0; trial < 60; ++trial) {
    const CurvePath path = mean_path(presses_of_site(1, 0, 1000 + 10 * trial), kInward, {}, "s");
    for (std::size_t i = 4; i < path.samples.size(); i += 5) {
      const CurveSample& s = path.samples[i];
      const double error =
          norm(s.force) - sneddon_force(s.displacement, bench.radius, bench.modulus);
      if (std::abs(error) <= 2 * s.force_uncertainty) ++inside;
      ++total;
    }
  }
  RecordProperty("inside_percent", 100 * inside / total);
  EXPECT_GE(inside, 0.88 * total);
}

/// Mindlin's ratio of the tangential to the normal stiffness of a contact without slip, nu = 1/2.
TEST(Repeats, ALateralPathIsMadeFromTheNormalStiffness) {
  const CurvePath normal = mean_path(presses_of_site(3, 0, 71), kInward, {}, "site");
  const CurvePath lateral = lateral_from_normal(normal, 2.0 / 3);
  EXPECT_EQ(lateral.kind, PathKind::Lateral);
  EXPECT_EQ(lateral.repeats, 0);
  EXPECT_NEAR(dot(lateral.direction, kInward), 0, 1e-12);
  const double h = lateral.lateral_depth, e = 1e-5;
  const Bench bench;
  const double k = (sneddon_force(h + e, bench.radius, bench.modulus) -
                    sneddon_force(h - e, bench.radius, bench.modulus)) /
                   (2 * e);
  const CurveSample& end = lateral.samples.back();
  EXPECT_NEAR(dot(end.force, lateral.direction), 2.0 / 3 * k * end.displacement,
              0.05 * k * end.displacement);
}

}  // namespace
}  // namespace palpate::measured
