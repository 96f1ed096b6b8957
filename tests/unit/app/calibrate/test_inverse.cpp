// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/calibrate/inverse.hpp"
#include "fem/campaign/campaign.hpp"
#include "fitting/measurement/compare/compare.hpp"
#include "format/error.hpp"
#include "format/numbers.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::app {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kTop = 9e3, kBase = 25e3;  // Pa, the truth

/// A soft half beside a stiff one, with a response vertex well inside each.
Body two_halves() {
  Body body = test::make_block(test::even(-0.02, 0.02, 4), test::even(-0.01, 0.01, 2),
                               test::even(-0.01, 0, 2));
  body.region_names = {"soft", "stiff"};
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    double x = 0;
    for (const std::int32_t n : body.tetrahedra[t]) {
      x += 0.25 * body.nodes[static_cast<std::size_t>(n)][0];
    }
    body.tetrahedron_region[t] = x > 0 ? 1 : 0;
  }
  return body;
}

std::vector<std::int32_t> sites_of(const Body& body) {
  std::vector<std::int32_t> sites;
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& x = body.nodes[static_cast<std::size_t>(body.response.node[v])];
    if (body.response.is_site[v] != 0 && std::abs(std::abs(x[0]) - 0.01) < 1e-9 &&
        std::abs(x[1]) < 1e-9) {
      sites.push_back(static_cast<std::int32_t>(v));
    }
  }
  return sites;
}

fem::CampaignSettings campaign(double soft, double stiff) {
  fem::CampaignSettings settings;
  settings.materials = {{"soft", {soft, 0.45}}, {"stiff", {stiff, 0.45}}};
  settings.indentation.tool.radius = 0.008;
  settings.indentation.depth = 0.002;
  settings.indentation.increments = 2;
  settings.indentation.force_tolerance = 1e-5;
  return settings;
}

/// What a bench would have measured on the body: the model at the truth, on a fine grid.
Curves truth_curves(const Body& body) {
  fem::CampaignSettings settings = campaign(kTop, kBase);
  settings.sites = sites_of(body);
  std::vector<double> depths;
  for (int i = 1; i <= 8; ++i) depths.push_back(0.002 * i / 8);
  Curves curves;
  curves.tool = {"sphere", 0.008, "frictionless"};
  for (const auto& site : fem::run_sensitivity(body, settings, depths, {})) {
    CurvePath path;
    path.direction = body.response.inward[static_cast<std::size_t>(site.vertex)];
    path.samples.emplace_back();
    for (const auto& s : site.samples) {
      CurveSample sample;
      sample.displacement = s.depth;
      sample.force = s.force * path.direction;
      path.samples.push_back(sample);
    }
    curves.sites.push_back({site.vertex, SiteStatus::Complete, "", 0, {path}});
  }
  return curves;
}

InverseSettings settings_from(double soft, double stiff) {
  InverseSettings settings;
  settings.campaign = campaign(soft, stiff);
  settings.sought = {{{"soft", "young"}, 100, 1e6}, {{"stiff", "young"}, 100, 1e6}};
  settings.depths = 4;
  settings.profiles = Profiles::None;
  return settings;
}

TEST(Inverse, FindsTheModuliThatMadeTheCurves) {
  const Body body = two_halves();
  const Curves truth = truth_curves(body);
  ASSERT_EQ(truth.sites.size(), 2U);
  const PressFit fit = calibrate_inverse(body, truth, settings_from(15e3, 15e3));
  EXPECT_TRUE(fit.calibration.converged);
  EXPECT_NEAR(fit.calibration.estimates[0].value, kTop, 2e-3 * kTop);
  EXPECT_NEAR(fit.calibration.estimates[1].value, kBase, 2e-3 * kBase);
  EXPECT_LT(fit.relative_rms, 1e-3);
  EXPECT_LT(fit.evaluations, 15);
}

/// A press alone hardly distinguishes Poisson's ratio from Young's modulus; a drag at the same site
/// does.
/// The truth is a campaign, as a robot would have gone through it.
TEST(Inverse, DragsTellPoissonsRatioFromTheModulus) {
  const Body body = two_halves();
  fem::CampaignSettings truth = campaign(kTop, kBase);
  truth.sites = {sites_of(body).front()};
  truth.indentation.increments = 4;
  truth.indentation.lateral_depths = {0.002};
  truth.indentation.lateral_travel = 0.0008;
  truth.indentation.lateral_increments = 4;
  truth.indentation.azimuths = {0.4};
  fem::CampaignReport report;
  Curves curves = fem::run_campaign(body, truth, report);
  for (CurvePath& path : curves.sites.front().paths) {
    path.repeats = 1;
    for (CurveSample& s : path.samples)
      s.force_uncertainty = 1e-3 * norm(path.samples.back().force);
  }
  InverseSettings settings = settings_from(12e3, kBase);
  settings.sought = {{{"soft", "young"}, 100, 1e6}, {{"soft", "poisson"}, 0.1, 0.499}};
  settings.campaign.materials[0].law.at("poisson") = 0.4;
  settings.drags = true;
  const PressFit fit = calibrate_inverse(body, curves, settings);
  ASSERT_EQ(fit.paths.size(), 2U);
  EXPECT_EQ(fit.paths[1].kind, PathKind::Lateral);
  EXPECT_TRUE(fit.calibration.converged);
  EXPECT_NEAR(fit.calibration.estimates[0].value, kTop, 5e-3 * kTop);
  EXPECT_NEAR(fit.calibration.estimates[1].value, 0.45, 2e-3);
  settings.drags = false;
  const PressFit alone = calibrate_inverse(body, curves, settings);
  EXPECT_EQ(alone.paths.size(), 1U);
  EXPECT_LT(2 * fit.calibration.estimates[1].standard_error,
            alone.calibration.estimates[1].standard_error);
  // What was made from the normal path is no measurement.
  curves.sites.front().paths.back().repeats = 0;
  settings.drags = true;
  EXPECT_EQ(calibrate_inverse(body, curves, settings).paths.size(), 1U);
}

/// A stiffening law under one press whose contact point is uncertain: the modulus costs no press,
/// as all forces are proportional to it, and is what a model presses that is not told so.
TEST(Inverse, FindsHowALawStiffensFromAPressOfUncertainContactPoint) {
  constexpr double kMu = 2e3, kB = 6;
  const Body body = test::make_block(test::even(-0.01, 0.01, 4), test::even(-0.01, 0.01, 4),
                                     test::even(-0.01, 0, 3));
  fem::CampaignSettings truth;
  truth.materials = {{"tissue", {"demiray-fung", {{"mu", kMu}, {"b", kB}, {"poisson", 0.45}}}}};
  truth.indentation.tool.radius = 0.006;
  truth.indentation.depth = 0.003;
  truth.indentation.increments = 6;
  truth.sites = {test::site_nearest(body)};
  std::vector<double> depths;
  for (int i = 1; i <= 6; ++i) depths.push_back(0.0005 * i);
  const auto pressed = fem::run_sensitivity(body, truth, depths, {});
  ASSERT_EQ(pressed.front().samples.size(), depths.size());
  Curves measured;
  measured.tool = {"sphere", 0.006, "frictionless"};
  CurvePath path;
  path.direction = body.response.inward[static_cast<std::size_t>(truth.sites.front())];
  path.contact_uncertainty = 2e-4;
  path.samples.emplace_back();
  const double noise = 0.003 * pressed.front().samples.back().force;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double force = pressed.front().samples[i].force + (i % 2 == 0 ? noise : -noise);
    CurveSample& sample = path.samples.emplace_back();
    sample.displacement = depths[i];
    sample.force = force * path.direction;
    sample.force_uncertainty =
        std::hypot(noise, 1.5 * force / depths[i] * path.contact_uncertainty);
  }
  measured.sites.push_back({truth.sites.front(), SiteStatus::Complete, "", 0, {path}});
  InverseSettings settings;
  settings.campaign = truth;
  settings.campaign.materials.front().law.at("mu") = 1e3;
  settings.campaign.materials.front().law.at("b") = 0.5;
  settings.sought = {{{"tissue", "mu"}, 10, 1e5}, {{"tissue", "b"}, 0.005, 50}};
  settings.profiles = Profiles::None;
  const PressFit fit = calibrate_inverse(body, measured, settings);
  EXPECT_TRUE(fit.calibration.converged);
  EXPECT_LE(fit.evaluations, 10);
  const auto& estimates = fit.calibration.estimates;
  EXPECT_LT(estimates[0].low, kMu);
  EXPECT_GT(estimates[0].high, kMu);
  EXPECT_LT(estimates[1].low, kB);
  EXPECT_GT(estimates[1].high, kB);
  // With the contact point given, what was fitted is what a press with the constants found meets.
  measured.sites.front().paths.front().contact_uncertainty = kUnknown;
  const PressFit given = calibrate_inverse(body, measured, settings);
  EXPECT_LE(given.evaluations, 10);
  for (std::size_t i = 0; i < 2; ++i)
    settings.campaign.materials.front().law.at(i == 0 ? "mu" : "b") =
        given.calibration.estimates[i].value;
  settings.campaign.sites = truth.sites;
  const auto again = fem::run_sensitivity(body, settings.campaign, depths, {});
  for (std::size_t i = 0; i < depths.size(); ++i)
    EXPECT_NEAR(given.paths.front().fitted[i], again.front().samples[i].force,
                1e-3 * again.front().samples[i].force);
}

/// Noise on every sample and a shift of the contact point of every curve, both as stated: the 95 %
/// intervals must hold the truth in about 95 % of many measurements.
TEST(Inverse, IntervalsCoverTheTruth) {
  constexpr int kTrials = 30;
  const Body body = two_halves();
  const Curves truth = truth_curves(body);
  std::mt19937 engine(5);
  std::normal_distribution<double> normal(0, 1);
  std::array<int, 2> inside{};
  for (int trial = 0; trial < kTrials; ++trial) {
    Curves measured = truth;
    for (SiteCurves& site : measured.sites) {
      CurvePath& path = site.paths.front();
      path.contact_uncertainty = 40e-6;
      const double shift = path.contact_uncertainty * normal(engine);
      std::vector<double> x, f;
      for (const CurveSample& s : path.samples) {
        x.push_back(s.displacement);
        f.push_back(norm(s.force));
      }
      const compare::MonotoneCubic curve(x, f);
      const double noise = 0.01 * f.back();
      for (std::size_t i = 1; i < path.samples.size(); ++i) {
        CurveSample& s = path.samples[i];
        s.force = (curve.value(x[i] + shift) + noise * normal(engine)) * path.direction;
        s.force_uncertainty = std::hypot(noise, curve.slope(x[i]) * path.contact_uncertainty);
      }
    }
    InverseSettings settings = settings_from(kTop, kBase);
    settings.depths = 4;
    const PressFit fit = calibrate_inverse(body, measured, settings);
    const std::array truth_values{kTop, kBase};
    for (std::size_t i = 0; i < 2; ++i) {
      const calibrate::Estimate& e = fit.calibration.estimates[i];
      if (e.low <= truth_values[i] && truth_values[i] <= e.high) ++inside[i];
    }
  }
  RecordProperty("soft", inside[0]);
  RecordProperty("stiff", inside[1]);
  // 28.5 expected, standard deviation 1.2.
  for (const int count : inside) EXPECT_GE(count, 25);
}

/// One site cannot distinguish the two constants of its region, and the fit warns of it.
TEST(Inverse, WarnsOfConstantsThatTheCurvesCannotTellApart) {
  const Body body = two_halves();
  Curves truth = truth_curves(body);
  InverseSettings settings = settings_from(kTop, kBase);
  settings.sought = {{{"soft", "young"}, 100, 1e6}, {{"soft", "poisson"}, 0.1, 0.499}};
  truth.sites.resize(1);
  const PressFit fit = calibrate_inverse(body, truth, settings);
  EXPECT_THAT(fit.calibration.warnings, Contains(HasSubstr("hardly distinguish them")));
}

/// The profile of one constant ends where the misfit itself, computed here from the forces at that
/// constant, has risen by t^2/2.
TEST(Inverse, ProfileEndsWhereTheMisfitHasRisen) {
  const Body body = two_halves();
  Curves measured = truth_curves(body);
  measured.sites.resize(1);
  CurvePath& path = measured.sites.front().paths.front();
  std::mt19937 engine(3);
  std::normal_distribution<double> normal(0, 1);
  const double noise = 0.002 * norm(path.samples.back().force);
  for (std::size_t i = 1; i < path.samples.size(); ++i) {
    path.samples[i].force = path.samples[i].force + noise * normal(engine) * path.direction;
    path.samples[i].force_uncertainty = noise;
  }
  InverseSettings settings = settings_from(kTop, kBase);
  settings.sought = {{{"soft", "poisson"}, 0.1, 0.4995}};
  settings.depths = 4;
  settings.profiles = Profiles::All;
  const PressFit one = calibrate_inverse(body, measured, settings);
  const calibrate::Estimate& e = one.calibration.estimates[0];
  std::vector<double> x, f;
  for (const CurveSample& s : path.samples) {
    x.push_back(s.displacement);
    f.push_back(dot(s.force, path.direction));
  }
  const compare::MonotoneCubic curve(x, f);
  const std::vector<double> depths{0.0005, 0.001, 0.0015, 0.002};
  const auto cost_at = [&](double poisson) {
    fem::CampaignSettings campaign = settings.campaign;
    campaign.materials[0].law.at("poisson") = poisson;
    campaign.sites = {measured.sites.front().vertex};
    double cost = 0;
    const auto site = fem::run_sensitivity(body, campaign, depths, {}).front();
    for (std::size_t i = 0; i < depths.size(); ++i)
      cost += 0.5 * std::pow((site.samples[i].force - curve.value(depths[i])) / noise, 2);
    return cost;
  };
  ASSERT_FALSE(one.calibration.widened);
  const double rise = 0.5 * 1.959964 * 1.959964;
  for (const double end : {e.profile_low, e.profile_high}) {
    ASSERT_GT(end, 0.1);
    ASSERT_LT(end, 0.4995);
    // To a hundredth of the distance: the root of the rise is within about a hundredth.
    EXPECT_NEAR(std::sqrt((cost_at(end) - one.calibration.cost) / rise), 1, 0.02) << end;
  }
  EXPECT_GT(one.profile_evaluations, 0);
  EXPECT_LE(one.profile_evaluations, 16);
  settings.profiles = Profiles::None;
  const PressFit none = calibrate_inverse(body, measured, settings);
  EXPECT_TRUE(std::isnan(none.calibration.estimates[0].profile_low));
  EXPECT_EQ(none.profile_evaluations, 0);
}

constexpr double kMu = 3e3, kB = 4;  // Pa and 1, the truth of a law that stiffens

/// A block of one law, and its site in the middle.
struct Stiffening {
  Body body = test::make_block(test::even(-0.02, 0.02, 4), test::even(-0.01, 0.01, 2),
                               test::even(-0.02, 0, 3));
  std::int32_t site = -1;
  InverseSettings settings;

  Stiffening() {
    body.region_names = {"gel"};
    for (std::size_t v = 0; v < body.response.node.size(); ++v) {
      const Vec3& x = body.nodes[static_cast<std::size_t>(body.response.node[v])];
      if (body.response.is_site[v] != 0 && std::hypot(x[0], x[1]) < 1e-9)
        site = static_cast<std::int32_t>(v);
    }
    settings.campaign = campaign(kTop, kTop);
    settings.campaign.materials = {
        {"gel", fem::LawConstants("demiray-fung", {{"mu", kMu}, {"b", kB}, {"poisson", 0.45}})}};
    settings.campaign.sites = {site};
    settings.sought = {{{"gel", "mu"}, 100, 1e6}, {{"gel", "b"}, 0.01, 50}};
    settings.depths = 8;
    settings.profiles = Profiles::None;
  }

  /// What a bench measures with a sphere, with its uncertainties.
  Curves pressed_by(double radius, double depth) const {
    fem::CampaignSettings truth = settings.campaign;
    truth.indentation.tool.radius = radius;
    std::vector<double> depths;
    for (int i = 1; i <= settings.depths; ++i) depths.push_back(depth * i / settings.depths);
    const auto samples = fem::run_sensitivity(body, truth, depths, {}).front().samples;
    CurvePath path;
    path.direction = body.response.inward[static_cast<std::size_t>(site)];
    path.contact_uncertainty = 2e-4;
    path.samples.emplace_back();
    path.samples.back().force_uncertainty = 0;
    for (const fem::ForceSensitivity& s : samples) {
      CurveSample& sample = path.samples.emplace_back();
      sample.displacement = s.depth;
      sample.force = s.force * path.direction;
      sample.force_uncertainty = std::hypot(0.01 * s.force, 0.002 * samples.back().force);
    }
    Curves curves;
    curves.tool = {"sphere", radius, "frictionless"};
    curves.sites.push_back({site, SiteStatus::Complete, "", 0, {path}});
    return curves;
  }
};

double half_width(const PressFit& fit, std::size_t constant) {
  const calibrate::Estimate& e = fit.calibration.estimates[constant];
  return 0.5 * (e.high - e.low);
}

/// A small sphere strains the body and shows how it stiffens, a large one shows how stiff it is at
/// rest: both together say more than twice as many presses of either.
TEST(Inverse, SpheresOfTwoRadiiTellTheStiffeningFromTheModulus) {
  const Stiffening bench;
  const Curves small = bench.pressed_by(0.003, 0.002), large = bench.pressed_by(0.020, 0.001);
  InverseSettings settings = bench.settings;
  settings.campaign.materials[0].law.at("mu") = 5e3;
  settings.campaign.materials[0].law.at("b") = 1;
  const auto fit_of = [&](const Curves& a, const Curves& b) {
    return calibrate_inverse(bench.body, std::vector{a, b}, settings);
  };
  const PressFit both = fit_of(small, large);
  EXPECT_NEAR(both.calibration.estimates[0].value, kMu, 0.002 * kMu);
  EXPECT_NEAR(both.calibration.estimates[1].value, kB, 0.002 * kB);
  ASSERT_EQ(both.paths.size(), 2U);
  EXPECT_EQ(both.paths[1].set, 1U);
  EXPECT_EQ(both.calibration.estimates[3].name,
            "contact shift of site " + std::to_string(bench.site) + ", curves 2");
  for (const Curves& twice : {small, large}) {
    const PressFit one = fit_of(twice, twice);
    EXPECT_LT(half_width(both, 0), 0.85 * half_width(one, 0));
    EXPECT_LT(half_width(both, 1), half_width(one, 1));
    EXPECT_LT(std::abs(both.calibration.correlation[0][1]),
              std::abs(one.calibration.correlation[0][1]));
  }
}

TEST(Inverse, RefusesWhatDoesNotFitTogether) {
  const Body body = two_halves();
  Curves curves = truth_curves(body);
  const auto refusal = [&](const Curves& measured, const InverseSettings& settings) {
    try {
      calibrate_inverse(body, measured, settings);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  InverseSettings settings = settings_from(kTop, kBase);
  settings.campaign.indentation.tool.radius = 0.004;
  EXPECT_THAT(refusal(curves, settings),
              HasSubstr("a tool of 8.00 mm radius, the case has 4.00 mm"));
  settings.campaign.indentation.tool.shape = fem::ToolShape::Disc;
  EXPECT_THAT(refusal(curves, settings),
              HasSubstr("made with a sphere, the tool of the case is a disc"));
  settings = settings_from(kTop, kBase);
  settings.sought.clear();
  EXPECT_THAT(refusal(curves, settings), HasSubstr("no constant is sought"));
  Curves none = curves;
  for (SiteCurves& site : none.sites) site.paths.clear();
  EXPECT_THAT(refusal(none, settings_from(kTop, kBase)), HasSubstr("no normal path"));
  Curves disc = curves;
  disc.tool.shape = "disc";
  try {
    calibrate_inverse(body, std::vector{curves, disc}, settings_from(kTop, kBase));
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(std::string(error.what()), HasSubstr("curves 2 were made with a disc"));
  }
  curves.sites.back().vertex = 9999;
  EXPECT_THAT(refusal(curves, settings_from(kTop, kBase)), HasSubstr("no site of the body"));
}

}  // namespace
}  // namespace palpate::app
