// SPDX-License-Identifier: AGPL-3.0-or-later
// The energies of the regions that a campaign on relaxing tissue stores with every sample.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/campaign/campaign.hpp"
#include "fem/laws/relaxation.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

const RelaxationSeries kSkinSeries{{0.3, 0.1}, {0.2, 1}};

/// A block whose lower half is another region.
Body skin_on_base() {
  Body body = test::make_block(test::even(-0.01, 0.01, 6), test::even(-0.01, 0.01, 6),
                               test::even(-0.01, 0, 4));
  body.region_names = {"skin", "base"};
  for (std::size_t e = 0; e < body.tetrahedra.size(); ++e) {
    double z = 0;
    for (const std::int32_t node : body.tetrahedra[e])
      z += 0.25 * body.nodes[static_cast<std::size_t>(node)][2];
    body.tetrahedron_region[e] = z < -0.005 ? 1 : 0;
  }
  return body;
}

CampaignSettings skin_settings(double skin, double base, bool relaxes = true) {
  CampaignSettings settings;
  settings.materials = {{"skin", with_isochoric_scaled({6e3, 0.45}, skin, "skin")},
                        {"base", with_isochoric_scaled({20e3, 0.48}, base, "base")}};
  if (relaxes) settings.materials[0].relaxation = kSkinSeries;
  settings.indentation.tool.radius = 0.005;
  settings.indentation.depth = 0.002;
  settings.indentation.increments = 4;
  settings.indentation.force_tolerance = 1e-6;
  settings.indentation.lateral_depths = {0.002};
  settings.indentation.lateral_travel = 0.0005;
  settings.indentation.lateral_increments = 1;
  return settings;
}

Curves skin_curves(const Body& body, const CampaignSettings& settings) {
  CampaignSettings one = settings;
  one.sites = {test::site_nearest(body)};
  CampaignReport report;
  return run_campaign(body, one, report);
}

double stored_energy(const CurveSample& sample) {
  return sample.strain_energy + sample.contact_energy;
}

TEST(IsochoricEnergies, AreThePartOfTheStoredEnergyThatRelaxes) {
  const Curves curves = skin_curves(skin_on_base(), skin_settings(1, 1));
  EXPECT_EQ(curves.relaxation.times_s, (std::vector<double>{0.1, 1}));
  EXPECT_EQ(curves.relaxation.fractions, (std::vector<std::vector<double>>{{0.3, 0.2}, {0, 0}}));
  ASSERT_EQ(curves.sites.front().status, SiteStatus::Complete);
  for (const CurvePath& path : curves.sites.front().paths)
    for (const CurveSample& sample : path.samples) {
      ASSERT_EQ(sample.isochoric_energy.size(), 2U);
      const double sum = sample.isochoric_energy[0] + sample.isochoric_energy[1];
      // The volumetric energy is positive and small at these Poisson's ratios.
      EXPECT_LE(sum, sample.strain_energy * (1 + 1e-12));
      EXPECT_GE(sum, 0.8 * sample.strain_energy);
    }
}

/// m_r dE/dm_r at a constant depth, by campaigns with the isochoric moduli of one region changed by
/// 1 %. The penalty of the contact follows the stiffness of the skin: its energy is the difference.
TEST(IsochoricEnergies, AreTheDerivativesOfTheStoredEnergyByTheModuli) {
  const Body body = skin_on_base();
  const Curves here = skin_curves(body, skin_settings(1, 1));
  const CurveSample& sample = here.sites[0].paths[0].samples.back();
  constexpr double h = 0.01;
  for (const std::size_t region : {0U, 1U}) {
    const auto stored_at = [&](double factor) {
      const Curves curves =
          skin_curves(body, skin_settings(region == 0 ? factor : 1, region == 1 ? factor : 1));
      return stored_energy(curves.sites[0].paths[0].samples.back());
    };
    const double slope = (stored_at(1 + h) - stored_at(1 - h)) / (2 * h);
    EXPECT_NEAR(sample.isochoric_energy[region], slope,
                sample.contact_energy + 5e-4 * sample.strain_energy)
        << region;
    EXPECT_GT(slope, 0.05 * sample.strain_energy);
  }
}

/// The energy of the relaxed body is a minimum over all displacements, so at most that of the
/// relaxed moduli at the displacements of the instantaneous body; the difference is of second order
/// in the fraction that relaxes.
TEST(IsochoricEnergies, BoundTheEnergyInTheLongTermFromAbove) {
  const Body body = skin_on_base();
  const Curves at_once = skin_curves(body, skin_settings(1, 1));
  const CurveSample& before = at_once.sites[0].paths[0].samples.back();
  const auto excess = [&](double fraction) {
    const Curves relaxed = skin_curves(body, skin_settings(1 - fraction, 1, false));
    const double bound = stored_energy(before) - fraction * before.isochoric_energy[0];
    return bound - stored_energy(relaxed.sites[0].paths[0].samples.back());
  };
  const double half = excess(0.5), quarter = excess(0.25);
  EXPECT_GT(quarter, 0);
  EXPECT_GT(half, 3 * quarter);
  EXPECT_LT(half, 7 * quarter);
  EXPECT_LT(half, 0.15 * 0.5 * before.isochoric_energy[0]);
}

TEST(IsochoricEnergies, OfElasticTissueAreNotStored) {
  const Curves curves = skin_curves(skin_on_base(), skin_settings(1, 1, false));
  EXPECT_TRUE(curves.relaxation.empty());
  EXPECT_TRUE(curves.sites[0].paths[0].samples.back().isochoric_energy.empty());
}

}  // namespace
}  // namespace palpate::fem
