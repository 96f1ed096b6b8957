// SPDX-License-Identifier: AGPL-3.0-or-later
// Half the increments with the energies that they store, against all of them without, at depths
// between the increments of both.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fem/campaign/indentation.hpp"
#include "fitting/response/couple.hpp"
#include "fitting/response/site_samples.hpp"
#include "format/to_index.hpp"
#include "runtime/response_curve.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fitting {
namespace {

constexpr double kTolerance = 0.01;

SiteCurves press(const Body& body, fem::CampaignSettings settings, int increments, int lateral) {
  settings.indentation.increments = increments;
  settings.indentation.lateral_increments = lateral;
  const fem::CampaignContext context(body, settings, fem::Engine::SharedFactor);
  SiteCurves site = fem::solve_site(context, 0, nullptr);
  EXPECT_EQ(site.status, SiteStatus::Complete) << site.reason;
  return site;
}

SiteCurves without_energies(SiteCurves site) {
  for (CurvePath& path : site.paths)
    for (CurveSample& sample : path.samples)
      sample.contact_energy = std::numeric_limits<double>::quiet_NaN();
  return site;
}

/// Largest error of a response over the tolerance of its fit, at all direct samples.
double error_of(const ResponseCurve& curve, double weight, const std::vector<ForceSample>& direct) {
  const runtime::CompiledCurve response(curve);
  const double peak = direct.back().force;
  double worst = 0;
  for (const ForceSample& sample : direct)
    worst = std::max(worst, std::abs(weight * response.force(sample.displacement) - sample.force) /
                                std::max(kTolerance * sample.force, kPeakFraction * peak));
  return worst;
}

struct Errors {
  double normal, lateral, coupled;
};

Errors errors_of(const SiteCurves& site, const SiteCurves& direct) {
  CurveFitSettings settings;
  settings.relative_tolerance = kTolerance;
  const CurveFit lateral = fit_curve(mean_lateral(lateral_paths(site)), settings, "lateral");
  const CoupledLateral coupled = fit_coupled(site, {}, normal_reach(site), settings, "coupled");
  settings.zero_first_slope = true;
  const CurveFit normal = fit_curve(normal_samples(site), settings, "normal");
  Errors errors{error_of(normal.curve, 1, normal_samples(direct)),
                error_of(lateral.curve, 1, mean_lateral(lateral_paths(direct))), 0};
  const runtime::CompiledCurve weight(coupled.coupling.curve,
                                      static_cast<double>(coupled.coupling.base));
  for (const double depth : lateral_depths(direct)) {
    SiteCurves one = direct;
    std::erase_if(one.paths, [&](const CurvePath& path) { return path.lateral_depth != depth; });
    errors.coupled = std::max(errors.coupled, error_of(coupled.lateral, weight.force(depth),
                                                       mean_lateral(lateral_paths(one))));
  }
  return errors;
}

struct Specimen {
  const char* name;
  double thickness;
  fem::LawConstants law;
  double depth;
};

class HalfTheIncrements : public testing::TestWithParam<Specimen> {};

TEST_P(HalfTheIncrements, GiveTheSameResponses) {
  const auto [name, thickness, law, depth] = GetParam();
  const auto across = test::graded(0.018, 0.005, 0.0025, 2);
  const Body body =
      test::make_block(across, across, {-thickness, -0.4 * thickness, -0.14 * thickness, 0});
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", law}};
  settings.indentation.tool.radius = 0.005;
  settings.indentation.depth = depth;
  settings.indentation.lateral_depths = {0.4 * depth, depth};
  settings.indentation.lateral_travel = 0.4 * depth;
  settings.points = {{{0.0007, 0.0004, 0}, {0, 0, -1}}};
  const SiteCurves direct = press(body, settings, 20, 12), all = press(body, settings, 10, 5),
                   half = press(body, settings, 5, 3);
  const Errors before = errors_of(without_energies(all), direct), after = errors_of(half, direct),
               without = errors_of(without_energies(half), direct);
  EXPECT_LE(after.normal, 1.03 * before.normal);
  EXPECT_LT(after.normal, without.normal);
  // Lateral responses are almost straight: the fit is within its tolerance, and what the mean over
  // depths or the coupling leaves is the same.
  EXPECT_LE(after.lateral, std::max(1.03 * before.lateral, 1.0));
  EXPECT_LE(after.coupled, std::max(1.03 * before.coupled, 1.0));
}

INSTANTIATE_TEST_SUITE_P(Specimens, HalfTheIncrements,
                         testing::Values(Specimen{"FlatBlock", 0.02, {10e3, 0.45}, 0.004},
                                         Specimen{"LayerOnASupport", 0.004, {10e3, 0.45}, 0.002},
                                         Specimen{"StiffeningLaw",
                                                  0.02,
                                                  {"demiray-fung",
                                                   {{"mu", 3e3}, {"b", 2.0}, {"poisson", 0.45}}},
                                                  0.004}),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace palpate::fitting
