// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/batch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "fitting/measurement/records/csv_table.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate::measured {
namespace {

using samples::expect_refusal;

constexpr double kRadius = 0.004, kNoise = 2e-3, kStuck = 0.1;

/// N, at a depth in m.
double truth(int site, double depth) {
  return (1 + 0.5 * site) * 4e3 * std::pow(depth, 1.5) * (1 + std::pow(depth / 0.002, 2));
}

Vec3 outward_of(int site) {
  const double turn = 0.2 * site;
  return {std::sin(turn), 0, std::cos(turn)};
}

Vec3 touch_of(int site) {
  return {0.005 * site, 0.01, 0.1};
}

/// Three sites pressed along their normals by a ball, logged by its centre; a tenth of the force
/// acts along y.
BatchLog log_of(double noise = 0) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 1);
  BatchLog log;
  log.name = "robot.csv";
  log.position_to_skin = kRadius;
  for (int site = 0; site < 3; ++site) {
    const Vec3 n = outward_of(site), centre = touch_of(site) + kRadius * n;
    for (int step = 0; step < 10; ++step) {
      const double depth = 0.003 * (step + 0.2) / 9.2, f = truth(site, depth);
      log.site.push_back(7 - site);
      log.contact.push_back(centre);
      log.outward.push_back(n);
      log.position.push_back(centre - depth * n);
      log.force.push_back(-(f + noise * normal(random)) * n + Vec3{0, kStuck * f, 0});
    }
  }
  return log;
}

BatchSettings settings() {
  BatchSettings settings;
  settings.press.method = ContactMethod::Given;
  settings.press.baseline = BaselineMethod::Zeroed;
  settings.press.zero_uncertainty = 1e-3;
  settings.press.contact_uncertainty = 1e-5;
  return settings;
}

void expect_batch_refused(const BatchLog& log, const std::string& problem, const std::string& where,
                          const BatchSettings& with = settings()) {
  expect_refusal([&] { split_batch(log, with); }, ErrorKind::Configuration, where, problem);
}

/// Site 6 is refused, and the others are as they are without it.
void expect_site_refused(const BatchLog& log, const std::string& problem,
                         const BatchSettings& with = settings()) {
  BatchSettings without = settings();
  without.leave_out = {"6"};
  const std::vector<BatchSite> others = split_batch(log_of(), without).sites;
  const Batch batch = split_batch(log, with);
  ASSERT_EQ(batch.refused.size(), 1U) << problem;
  EXPECT_EQ(batch.refused[0].name, "site 6");
  expect_refusal([&] { throw batch.refused[0].reason; }, ErrorKind::Configuration,
                 "robot.csv, site 6", problem);
  ASSERT_EQ(batch.sites.size(), others.size());
  for (std::size_t i = 0; i < others.size(); ++i) {
    EXPECT_EQ(batch.sites[i].name, others[i].name);
    EXPECT_EQ(batch.sites[i].contact, others[i].contact);
    ASSERT_EQ(batch.sites[i].press.loading.size(), others[i].press.loading.size());
    EXPECT_EQ(batch.sites[i].press.loading.back().force, others[i].press.loading.back().force);
  }
}

TEST(Batch, SplitsTheLogIntoPressesAlongTheirNormals) {
  const std::vector<BatchSite> sites = split_batch(log_of(), settings()).sites;
  ASSERT_EQ(sites.size(), 3U);
  EXPECT_EQ(sites.front().name, "site 5") << "in order of their numbers";
  for (std::size_t i = 0; i < 3; ++i) {
    const int site = 2 - static_cast<int>(i);
    EXPECT_LT(norm(sites[i].contact - touch_of(site)), 1e-9) << "on the skin, not at the centre";
    EXPECT_LT(norm(sites[i].outward - outward_of(site)), 1e-9);
    EXPECT_NEAR(sites[i].lateral_fraction, kStuck, 1e-9);
    EXPECT_LT(sites[i].sideways, 1e-9);
    ASSERT_EQ(sites[i].press.loading.size(), 10U);
    for (const DepthForce& sample : sites[i].press.loading)
      EXPECT_NEAR(sample.force, truth(site, sample.depth), 1e-9);
  }
}

TEST(Batch, LeavesSitesOut) {
  BatchSettings without = settings();
  without.leave_out = {"6"};
  const std::vector<BatchSite> sites = split_batch(log_of(), without).sites;
  ASSERT_EQ(sites.size(), 2U);
  EXPECT_EQ(sites.back().name, "site 7");
  without.leave_out = {"9"};
  expect_batch_refused(log_of(), "no site '9'", "robot.csv", without);
  without.leave_out = {"5", "6", "7"};
  expect_batch_refused(log_of(), "no site is left", "robot.csv", without);
}

TEST(Batch, FindsTheContactPointWhereItIsNotGiven) {
  // An approach of 1 mm in 200 samples before the touch, then 3 mm.
  BatchLog log = log_of();
  const Vec3 n = outward_of(1);
  log.site.clear();
  log.contact.clear();
  log.outward.clear();
  log.position.clear();
  log.force.clear();
  for (int i = 0; i <= 800; ++i) {
    const double depth = -0.001 + 5e-6 * i;
    log.site.push_back(1);
    log.outward.push_back(n);
    log.position.push_back(touch_of(1) + (kRadius - depth) * n);
    log.force.push_back(depth > 0 ? -4e3 * std::pow(depth, 1.5) * n : Vec3{});
  }
  BatchSettings found = settings();
  found.press.method = ContactMethod::Fit;
  found.press.baseline = BaselineMethod::Fit;
  const std::vector<BatchSite> sites = split_batch(log, found).sites;
  ASSERT_EQ(sites.size(), 1U);
  EXPECT_LT(norm(sites[0].contact - touch_of(1)), 2e-5);
}

TEST(Batch, LeavesASiteOutWhosePressCannotBeUsed) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  BatchLog log = log_of();
  log.force[13][1] = nan;
  expect_site_refused(log, "row 14 has a value that is not finite");
  log = log_of();
  for (std::size_t row = 10; row < 20; ++row) log.outward[row] = -log.outward[row];
  expect_site_refused(log, "moves out of the body along its normal");
  log = log_of();
  for (std::size_t row = 10; row < 20; ++row) log.force[row] = -log.force[row];
  expect_site_refused(log, "the force points out of the body");
  log = log_of();
  for (std::size_t row = 10; row < 20; ++row) log.outward[row] = 0.5 * log.outward[row];
  expect_site_refused(log, "not 1");
  log = log_of();
  log.outward[12] = {0, 1, 0};
  expect_site_refused(log, "its normal changes");
  log = log_of();
  log.contact[12][0] += 1e-3;
  expect_site_refused(log, "its contact point changes");
  BatchSettings checked = settings();
  checked.check = [](const BatchSite& site, const std::string& where) {
    if (site.name == "site 6") refuse(where, "is too soft", "take another");
  };
  expect_site_refused(log_of(), "is too soft", checked);
}

/// A row that belongs to no site may belong to any, and what no site fulfils is no fault of a site.
TEST(Batch, RefusesAsAWholeWhatIsNoFaultOfASite) {
  BatchLog log = log_of();
  for (Vec3& force : log.force) force = -force;
  expect_batch_refused(log, "none of the 3 sites can be used", "robot.csv, site 5");
  log = log_of();
  log.site[4] = 0.5;
  expect_batch_refused(log, "row 5: its site is no whole number", "robot.csv");
  log.site.pop_back();
  expect_batch_refused(log, "different lengths", "robot.csv");
}

TEST(Batch, RecordedPathsKeepTheSamplesAndStateTheirUncertainty) {
  const std::vector<BatchSite> sites = split_batch(log_of(kNoise), settings()).sites;
  const RecordedPathSettings with{kNoise, 0.02, 0};
  int inside = 0, count = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Vec3 inward = -sites[i].outward;
    const CurvePath path = recorded_path(sites[i].press, inward, with, "site");
    ASSERT_EQ(path.samples.size(), 11U) << "the touch and ten samples";
    EXPECT_EQ(path.repeats, 1);
    EXPECT_EQ(path.samples.front().displacement, 0);
    for (std::size_t k = 1; k < path.samples.size(); ++k) {
      const CurveSample& s = path.samples[k];
      const double f = truth(2 - static_cast<int>(i), s.displacement);
      // Noise, zero and calibration, and what the contact point adds.
      EXPECT_GE(s.force_uncertainty, std::hypot(kNoise, 1e-3, 0.02 * dot(s.force, inward)));
      EXPECT_LT(s.force_uncertainty, std::hypot(kNoise, 1e-3, 0.04 * f) + 1e-3);
      ++count;
      if (std::abs(dot(s.force, inward) - f) <= 2 * s.force_uncertainty) ++inside;
    }
  }
  EXPECT_GE(inside, count * 9 / 10);
}

TEST(Batch, RecordedPathsGoDeeperFromSampleToSample) {
  PressCurve press;
  press.loading = {{1e-3, 0.1, 0}, {2e-3, 0.2, 1}, {1.9e-3, 0.3, 2}};
  expect_refusal(
      [&] {
        recorded_path(press, {0, 0, -1}, {}, "site 3");
      },
      ErrorKind::Configuration, "site 3", "does not increase");
}

TEST(CsvTable, ColumnsWithoutUnitArePureNumbers) {
  const CsvTable table =
      parse_csv("site,nx,x_mm\n1,0.5,3\n1,0.5,4\n2,0.1,5\n2,0.1,6\n3,0.2,7\n", "robot.csv");
  EXPECT_EQ(column_without_unit(table, "site"), (std::vector<double>{1, 1, 2, 2, 3}));
  expect_refusal([&] { column_without_unit(table, "x"); }, ErrorKind::Configuration, "column 'x'",
                 "has the unit 'mm'");
  expect_refusal([&] { column_without_unit(table, "y"); }, ErrorKind::Configuration, "robot.csv",
                 "no column is named 'y'");
}

}  // namespace
}  // namespace palpate::measured
