// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/bonded_patch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/patch_work.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;

Body block() {
  return test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                          test::even(-0.012, 0, 3));
}

CampaignSettings pressing(const LawConstants& law) {
  CampaignSettings settings;
  settings.materials = {{"tissue", law}};
  settings.indentation.depth = 0.005;
  settings.indentation.increments = 20;
  settings.indentation.lateral_depths.clear();
  return settings;
}

TEST(BondedPatch, HasTheSurfaceNodesWithinItsRadius) {
  const Body body = block();
  const BondedPatch patch = bonded_patch(body, test::site_nearest(body), 0.0081);
  for (const std::int32_t node : patch.nodes) {
    EXPECT_NEAR(patch.mesh.X(2, node), 0, 1e-12);
    EXPECT_LT(patch.mesh.X.col(node).norm(), 0.0082);
    EXPECT_TRUE(patch.mesh.is_free(node));
  }
  int corners = 0;
  for (const std::int32_t node : patch.nodes) corners += node < patch.mesh.corners() ? 1 : 0;
  EXPECT_EQ(corners, 5);  // the site and its four neighbours at 8 mm
}

TEST(BondedPatch, RefusesVerticesRadiiAndPatchesThatCannotBe) {
  const Body body = block();
  const std::int32_t site = test::site_nearest(body);
  EXPECT_THROW(bonded_patch(body, -1, 0.008), Error);
  EXPECT_THROW(bonded_patch(body, site, 0), Error);
  EXPECT_THROW(bonded_patch(body, site, 1), Error);  // reaches the base
}

/// At small depth the force is proportional to the depth, and its work is the stored energy.
TEST(BondedPatch, StoresTheWorkOfItsForce) {
  CampaignSettings settings = pressing({10e3, 0.45});
  settings.indentation.depth = 0.002;
  const Body body = block();
  test::expect_work_is_stored(press_patch(body, settings, test::site_nearest(body), 0.0081));
}

TEST(BondedPatch, EndsThePathWhereStrongEllipticityIsLost) {
  const Body body = block();
  CampaignSettings settings =
      pressing({"yeoh", {{"C10", 1.5e3}, {"C20", -2.5e3}, {"C30", 1.6e3}, {"poisson", 0.45}}});
  const PatchCurve softening = press_patch(body, settings, test::site_nearest(body), 0.0081);
  EXPECT_THAT(softening.reason, HasSubstr("strong ellipticity is lost in the element at ("));
  EXPECT_GT(softening.samples.size(), 2u);
  EXPECT_LT(softening.samples.back().depth, 0.005);
  settings.materials[0].law = {2 * 1.45 * 3e3, 0.45};
  const PatchCurve sound = press_patch(body, settings, test::site_nearest(body), 0.0081);
  EXPECT_EQ(sound.reason, "");
  EXPECT_EQ(sound.samples.size(), 21u);
}

}  // namespace
}  // namespace palpate::fem
