// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace palpate::compare
