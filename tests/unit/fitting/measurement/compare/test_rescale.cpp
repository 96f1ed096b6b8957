// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fitting/measurement/compare/rescale.hpp"
#include "format/error.hpp"

namespace palpate::compare {
namespace {

const Vec3 kInward{0, 0, -1};

Curves curves_of(const std::vector<std::int32_t>& vertices, double scale, double power = 1.5) {
  Curves curves;
  for (const std::int32_t v : vertices) {
    CurvePath path;
    path.direction = kInward;
    for (int i = 0; i <= 20; ++i) {
      CurveSample sample;
      sample.displacement = 0.005 * i / 20;
      sample.force =
          scale * (1 + 0.01 * v) * std::pow(sample.displacement / 0.005, power) * kInward;
      sample.strain_energy = sample.tool_work = norm(sample.force) * sample.displacement / 2.5;
      sample.isochoric_energy = {0.9 * sample.strain_energy};
      path.samples.push_back(sample);
    }
    curves.sites.push_back({v, SiteStatus::Complete, "", 0, {path}});
  }
  return curves;
}

/// A few measured sites set the scale of the whole simulation, energies included.
TEST(Rescale, TheMeasuredScaleReachesEverySite) {
  const Rescaling r = rescale(curves_of({0, 1, 2, 3, 4}, 1), curves_of({1, 3}, 1.4), {});
  EXPECT_NEAR(r.factor, 1.4, 1e-12);
  ASSERT_EQ(r.sites.size(), 2U);
  EXPECT_NEAR(r.sites[0].misfit, 0, 1e-12);
  ASSERT_EQ(r.curves.sites.size(), 5U);
  const CurveSample& end = r.curves.sites[4].paths[0].samples.back();
  EXPECT_NEAR(norm(end.force), 1.4 * 1.04, 1e-12);
  EXPECT_NEAR(end.strain_energy, 1.4 * 1.04 * 0.005 / 2.5, 1e-12);
  // The part of the energy that relaxes stays the same.
  EXPECT_NEAR(end.isochoric_energy[0], 0.9 * end.strain_energy, 1e-12);
}

/// The error of the mesh is a part of the force.
TEST(Rescale, TheErrorOfTheMeshScalesWithTheForce) {
  Curves simulated = curves_of({0, 1}, 1);
  for (SiteCurves& site : simulated.sites) {
    CurveSample& end = site.paths[0].samples.back();
    end.mesh_error = 0.03 * norm(end.force);
    end.mesh_difference = -0.02 * norm(end.force);
  }
  const Rescaling r = rescale(simulated, curves_of({1}, 1.4), {});
  const CurveSample& end = r.curves.sites[0].paths[0].samples.back();
  EXPECT_NEAR(end.mesh_error, 0.03 * norm(end.force), 1e-12);
  EXPECT_NEAR(end.mesh_difference, -0.02 * norm(end.force), 1e-12);
}

TEST(Rescale, SitesThatDisagreeAreInTheUncertainty) {
  Curves measured = curves_of({0, 1, 2}, 1);
  const double factors[] = {1.0, 1.2, 1.4};
  for (std::size_t i = 0; i < 3; ++i) {
    for (CurveSample& s : measured.sites[i].paths[0].samples) s.force = factors[i] * s.force;
  }
  const Rescaling r = rescale(curves_of({0, 1, 2}, 1), measured, {});
  EXPECT_NEAR(r.factor, 1.2, 1e-12);
  EXPECT_NEAR(r.uncertainty, 0.2 / std::sqrt(3.0), 1e-12);
}

TEST(Rescale, AnotherShapeIsToldByTheMisfit) {
  const Rescaling r = rescale(curves_of({0}, 1), curves_of({0}, 1, 2.5), {});
  EXPECT_GT(r.sites[0].misfit, 0.05);
}

TEST(Rescale, RefusesWhatHasNoScale) {
  EXPECT_THROW(rescale(curves_of({0}, 1), curves_of({1}, 1), {}), Error);
  EXPECT_THROW(rescale(curves_of({0}, 1), curves_of({0}, -1), {}), Error);
}

// A ramp of constant speed into a linear response, then a hold, of tissue with one relaxation time:
//   f = k v (g_inf t + g tau (1 - exp(-t/tau)))                                     while it moves,
//   f = k v (g_inf t_r + g tau (exp(-(t - t_r)/tau) - exp(-t/tau)))                 while it is
//   held.
struct RampAndHold {
  double stiffness, speed, ramp, fraction, time;

  double force(double t) const {
    const double moved = std::min(t, ramp), g = fraction, tau = time;
    return stiffness * speed *
           ((1 - g) * moved + g * tau * (std::exp(-(t - moved) / tau) - std::exp(-t / tau)));
  }

  measured::SiteHistory record(std::int32_t vertex, double touch = 0.2) const {
    measured::SiteHistory site;
    site.vertex = vertex;
    site.history.name = "ramp.csv";
    for (int i = 0; i <= 300; ++i) {
      const double t = 0.02 * i - touch;
      site.history.time.push_back(0.02 * i);
      site.history.travel.push_back(speed * std::min(t, ramp));
      site.history.force.push_back(t > 0 ? force(t) : 0);
    }
    return site;
  }
};

Curves relaxing_curves(double scale) {
  Curves curves = curves_of({0, 1, 2}, scale, 1);
  curves.relaxation = {{0.5}, {{0.6}}};
  for (SiteCurves& site : curves.sites)
    for (CurveSample& sample : site.paths[0].samples)
      sample.isochoric_energy = {sample.strain_energy};
  return curves;
}

/// Whether the press is slow or fast, the scale is that of the tissue before it relaxes.
TEST(RescaleOverTime, TheTimeOfThePressDoesNotBiasTheScale) {
  const double stiffness = 1.7 * 1.01 / 0.005;  // of 1.7 times the simulated site 1
  for (const double speed : {0.002, 0.02}) {
    const RampAndHold press{stiffness, speed, 0.004 / speed, 0.6, 0.5};
    const Rescaling r = rescale_over_time(relaxing_curves(1), {press.record(1)});
    EXPECT_NEAR(r.factor, 1.7, 1.7e-4) << speed;
    EXPECT_LT(r.sites[0].misfit, 1e-4) << speed;
    EXPECT_NEAR(norm(r.curves.sites[2].paths[0].samples.back().force), 1.02 * r.factor, 1e-12);
  }
}

/// Elastic curves fit the same record with a misfit, and too soft.
TEST(RescaleOverTime, CurvesThatDoNotRelaxLeaveAMisfit) {
  const RampAndHold press{340, 0.002, 2, 0.6, 0.5};
  const Rescaling r = rescale_over_time(curves_of({1}, 1, 1), {press.record(1)});
  EXPECT_LT(r.factor, 1.2);
  EXPECT_GT(r.sites[0].misfit, 0.05);
}

/// What lies deeper than the campaign is not extrapolated.
TEST(RescaleOverTime, SamplesBeyondTheCampaignAreLeftOut) {
  const RampAndHold press{1.7 * 1.01 / 0.005, 0.002, 4, 0.6, 0.5};  // to 8 mm of 5
  measured::SiteHistory record = press.record(1);
  for (std::size_t i = 0; i < record.history.force.size(); ++i)
    if (record.history.travel[i] > 0.005) record.history.force[i] = 100;
  EXPECT_NEAR(rescale_over_time(relaxing_curves(1), {record}).factor, 1.7, 1e-3);
  record.history.travel.assign(record.history.travel.size(), 0.02);
  EXPECT_THROW(rescale_over_time(relaxing_curves(1), {record}), Error);
}

TEST(RescaleOverTime, ARecordAtNoSimulatedSiteIsRefused) {
  const RampAndHold press{340, 0.002, 2, 0.6, 0.5};
  EXPECT_THROW(rescale_over_time(relaxing_curves(1), {press.record(7)}), Error);
  EXPECT_THROW(rescale_over_time(relaxing_curves(1), {}), Error);
}

}  // namespace
}  // namespace palpate::compare
