// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/slab_fit.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/app/calibrate/pressed_layer.hpp"

namespace palpate::app {
namespace {

using samples::pressed_sites;

const SlabTable& table() {
  static const SlabTable kTable = samples::layer_table();
  return kTable;
}

TEST(SlabFit, FindsTheLayerThatWasPressed) {
  const SlabFit slab = fit_slab(pressed_sites(1.5, 0.009, 1e-6, 1), table(), {});
  EXPECT_NEAR(slab.thickness.value, 0.009, 1e-4);
  EXPECT_NEAR(slab.stiffening.value, 1.5, 0.02);
  EXPECT_TRUE(slab.thickness.is_interval());
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(slab.fit.calibration.estimates[2 + i].value / (400 * (1 + 0.2 * double(i))), 1,
                0.02);
}

/// 57 of 60 intervals of 95 % are expected to hold the truth; fewer than 52 do so by chance in
/// about one of a hundred programs, and the seeds are fixed.
TEST(SlabFit, ItsIntervalsCover) {
  int thickness = 0, stiffening = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const SlabFit slab = fit_slab(pressed_sites(1.5, 0.008, 2e-3, seed, 4), table(), {});
    thickness += slab.thickness.low <= 0.008 && 0.008 <= slab.thickness.high;
    stiffening += slab.stiffening.low <= 1.5 && 1.5 <= slab.stiffening.high;
  }
  EXPECT_GE(thickness, 52);
  EXPECT_GE(stiffening, 52);
}

/// A base so far away that the noise hides it is reported as no more than a bound.
TEST(SlabFit, ReportsAThicknessThatCannotBeKnownAsABound) {
  const SlabFit slab = fit_slab(pressed_sites(1.5, 0.055, 5e-3, 3), table(), {});
  EXPECT_TRUE(slab.thickness.no_high);
  EXPECT_FALSE(slab.thickness.is_interval());
  EXPECT_LE(slab.thickness.low, 0.055);
}

TEST(SlabFit, ReportsThatNothingIsKnownWhereTheNoiseHidesAll) {
  const SlabFit slab = fit_slab(pressed_sites(1.5, 0.02, 0.5, 5, 2), table(), {});
  EXPECT_TRUE(slab.thickness.is_nothing());
}

TEST(SlabFit, GivesItsForcesAsCurvesOfTheSameSites) {
  const Curves measured = pressed_sites(1.0, 0.01, 1e-6, 2);
  const SlabFit slab = fit_slab(measured, table(), {});
  const Curves fitted = fitted_curves(measured, slab.fit);
  ASSERT_EQ(fitted.sites.size(), measured.sites.size());
  EXPECT_EQ(fitted.tool.radius, measured.tool.radius);
  for (std::size_t i = 0; i < fitted.sites.size(); ++i) {
    const Vec3& own = fitted.sites[i].paths.front().samples.back().force;
    const Vec3& theirs = measured.sites[i].paths.front().samples.back().force;
    EXPECT_NEAR(own[2], theirs[2], 2e-3 * std::abs(theirs[2]));
  }
  const palpate::samples::TemporaryFolder folder;
  EXPECT_NO_THROW(write_curves(folder / "curves.h5", fitted));
}

}  // namespace
}  // namespace palpate::app
