// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/press_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "format/error.hpp"
#include "tests/unit/app/calibrate/pressed_layer.hpp"

namespace palpate::app {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// F = k times the force of a thick layer, with k for all sites.
class OneStiffness : public PressModel {
 public:
  std::vector<calibrate::Constant> constants(const PressPlan&) const override {
    return {{"k", "Pa", 100, 1, 1e6}};
  }
  std::size_t profiled(const PressPlan&) const override { return 1; }
  bool forces(const PressPlan& plan, const std::vector<double>& at,
              std::vector<fem::SiteSensitivity>& sites, std::string&) override {
    sites.assign(plan.vertices.size(), {});
    for (fem::SiteSensitivity& site : sites) {
      site.reason = "it ends early";
      for (const double depth : plan.depths)
        if (depth < reach) site.samples.push_back({depth, at[0] * unit(depth), {unit(depth)}});
    }
    return true;
  }
  static double unit(double depth) { return samples::layer_force(depth, 0, 10); }
  double reach = 1;
};

TEST(PressFit, FindsTheConstantOfAModelAndTheContactPoint) {
  Curves measured = samples::pressed_sites(0, 10, 1e-5, 1, 1);
  CurvePath& path = measured.sites.front().paths.front();
  path.contact_uncertainty = 1e-4;
  // The tool touched 50 um later than the record says.
  for (CurveSample& sample : path.samples)
    sample.force =
        (400 * OneStiffness::unit(std::max(0.0, sample.displacement - 5e-5))) * path.direction;
  OneStiffness model;
  const PressFit fit = fit_presses({&measured, 1}, model, {}, "test");
  ASSERT_EQ(fit.paths.size(), 1U);
  EXPECT_NEAR(fit.calibration.estimates[0].value, 400, 8);
  EXPECT_NEAR(fit.paths[0].contact_shift, -5e-5, 1e-5);
}

/// F = mu times a force whose stiffening grows slower and slower with b, as under a small sphere.
class Stiffening : public PressModel {
 public:
  explicit Stiffening(bool knows_its_modulus) : knows_(knows_its_modulus) {}

  std::vector<calibrate::Constant> constants(const PressPlan&) const override {
    return {{"mu", "Pa", 300, 3, 3e4}, {"b", "1", 1, 0.01, 100}};
  }
  std::size_t profiled(const PressPlan&) const override { return 2; }
  std::optional<std::size_t> modulus() const override {
    return knows_ ? std::optional<std::size_t>(0) : std::nullopt;
  }
  bool forces(const PressPlan& plan, const std::vector<double>& at,
              std::vector<fem::SiteSensitivity>& sites, std::string&) override {
    sites.assign(plan.vertices.size(), {});
    for (fem::SiteSensitivity& site : sites)
      for (const double depth : plan.depths) {
        const double unit = samples::layer_force(depth, 0, 10), d = 100 * depth;
        const double stiffened = std::pow(1 + at[1] * d, 0.3), by_b = 0.3 * d / (1 + at[1] * d);
        const double force = at[0] * unit * stiffened;
        site.samples.push_back({depth, force, {unit * stiffened, force * by_b}});
      }
    return true;
  }

 private:
  bool knows_;
};

/// Presses of mu = 250 and b = 40, touched later than the record says, whose contact point is
/// uncertain by a tenth of the depth.
Curves doubtful_touch(double late) {
  Curves measured = samples::pressed_sites(0, 10, 1e-5, 1, 1);
  CurvePath& path = measured.sites.front().paths.front();
  path.contact_uncertainty = 3e-4;
  for (CurveSample& sample : path.samples) {
    const double depth = std::max(0.0, sample.displacement - late);
    const double force =
        250 * samples::layer_force(depth, 0, 10) * std::pow(1 + 40 * 100 * depth, 0.3);
    sample.force = force * path.direction;
    sample.force_uncertainty = 2e-3 + 1.5 * path.contact_uncertainty * force / 0.003;
  }
  return measured;
}

/// The modulus, the stiffening and the contact point can stand for each other. A modulus that the
/// model knows as such costs no evaluation and changes nothing.
TEST(PressFit, ConvergesWhereConstantsStandForEachOther) {
  for (const double late : {-2e-4, 0.0, 2e-4}) {
    const Curves measured = doubtful_touch(late);
    Stiffening known(true), unknown(false);
    PressFitSettings settings;
    settings.profiles = Profiles::None;
    const PressFit with = fit_presses({&measured, 1}, known, settings, "test");
    const PressFit without = fit_presses({&measured, 1}, unknown, settings, "test");
    EXPECT_LE(with.evaluations, 8);
    EXPECT_LE(without.evaluations, 20);
    EXPECT_NEAR(with.calibration.cost, without.calibration.cost, 1e-3);
    for (std::size_t i = 0; i < 2; ++i) {
      const double value = without.calibration.estimates[i].value;
      EXPECT_NEAR(with.calibration.estimates[i].value, value, 0.05 * value);
    }
    EXPECT_LT(with.relative_rms, 0.02);
  }
}

/// What a linearised interval says beside a constant at its bound is half of it: profiles say more.
TEST(PressFit, HasProfilesBesideAConstantAtItsBound) {
  const Curves measured = doubtful_touch(4e-4);
  Stiffening model(true);
  const PressFit fit = fit_presses({&measured, 1}, model, {}, "test");
  const calibrate::Estimate &mu = fit.calibration.estimates[0], &b = fit.calibration.estimates[1];
  ASSERT_TRUE(b.at_bound);
  EXPECT_EQ(b.profile_high, 100);
  EXPECT_LT(b.profile_low, 40);
  EXPECT_LT(mu.high, 250);
  EXPECT_GT(mu.profile_high, 250);
  EXPECT_THAT(fit.calibration.warnings,
              Contains(HasSubstr("b is not determined between its bounds")));
}

TEST(PressFit, SaysWhyItHasNoModel) {
  OneStiffness model;
  model.reach = 1e-3;
  const Curves deep = samples::pressed_sites(0, 10, 1e-5, 1, 1), none;
  EXPECT_THROW(fit_presses({&deep, 1}, model, {}, "test"), Error);
  EXPECT_THROW(fit_presses({&none, 1}, model, {}, "test"), Error);
}

}  // namespace
}  // namespace palpate::app
