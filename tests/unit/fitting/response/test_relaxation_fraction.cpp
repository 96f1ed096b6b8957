// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/relaxation_fraction.hpp"

#include <gtest/gtest.h>

#include "format/error.hpp"

namespace palpate::fitting {
namespace {

/// Two regions of which the first takes `fractions` of the energy of each sample, as two springs in
/// series do; `isochoric`: part of the energy that is not volumetric.
SiteCurves site_of(const std::vector<double>& fractions, double isochoric) {
  SiteCurves site;
  site.vertex = 7;
  CurvePath path;
  path.kind = PathKind::Normal;
  path.samples.emplace_back();
  path.samples.back().isochoric_energy = {0, 0};
  double energy = 0;
  for (const double fraction : fractions) {
    CurveSample sample;
    energy += 1e-4;
    sample.displacement = 1e-3 * static_cast<double>(path.samples.size());
    sample.strain_energy = energy;
    sample.isochoric_energy = {isochoric * fraction * energy, isochoric * (1 - fraction) * energy};
    path.samples.push_back(sample);
  }
  site.paths = {path};
  return site;
}

const RegionRelaxation kOne{{0.1, 2}, {{0.3, 0.1}, {0.3, 0.1}}};
const RegionRelaxation kTwo{{0.1, 2}, {{0.4, 0}, {0, 0.2}}};

TEST(RelaxationFractions, AreTheSeriesOfIncompressibleTissueOfOneKind) {
  const SiteCurves site = site_of({0.2, 0.5, 0.7}, 1);
  const std::vector<float> fractions = relaxation_fractions(site, kOne);
  ASSERT_EQ(fractions.size(), 2U);
  EXPECT_FLOAT_EQ(fractions[0], 0.3F);
  EXPECT_FLOAT_EQ(fractions[1], 0.1F);
  EXPECT_NEAR(largest_fraction_error(site, kOne), 0, 1e-15);
}

TEST(RelaxationFractions, LeaveTheVolumetricEnergyOut) {
  const std::vector<float> fractions = relaxation_fractions(site_of({0.5}, 0.9), kOne);
  EXPECT_FLOAT_EQ(fractions[0], 0.27F);
}

TEST(RelaxationFractions, WeighRegionsByTheirEnergyAtTheDeepestSample) {
  const SiteCurves site = site_of({0.2, 0.5, 0.7}, 1);
  const std::vector<float> fractions = relaxation_fractions(site, kTwo);
  EXPECT_FLOAT_EQ(fractions[0], 0.7F * 0.4F);
  EXPECT_FLOAT_EQ(fractions[1], 0.3F * 0.2F);
  // At the second sample, of two thirds of the energy, 0.3 in all relaxes instead of 0.34; at the
  // first, of one third, 0.24.
  EXPECT_NEAR(largest_fraction_error(site, kTwo), 0.1 / 3, 1e-12);
}

TEST(RelaxationFractions, RefuseCurvesWithoutTheEnergiesOfTheRegions) {
  SiteCurves site = site_of({0.5}, 1);
  site.paths[0].samples.back().isochoric_energy.clear();
  EXPECT_THROW(relaxation_fractions(site, kOne), Error);
}

}  // namespace
}  // namespace palpate::fitting
