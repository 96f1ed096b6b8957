// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/press_fit.hpp"

#include <gtest/gtest.h>

#include "format/error.hpp"
#include "tests/unit/app/calibrate/pressed_layer.hpp"

namespace palpate::app {
namespace {

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

TEST(PressFit, SaysWhyItHasNoModel) {
  OneStiffness model;
  model.reach = 1e-3;
  const Curves deep = samples::pressed_sites(0, 10, 1e-5, 1, 1), none;
  EXPECT_THROW(fit_presses({&deep, 1}, model, {}, "test"), Error);
  EXPECT_THROW(fit_presses({&none, 1}, model, {}, "test"), Error);
}

}  // namespace
}  // namespace palpate::app
