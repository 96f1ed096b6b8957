// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/region_laws.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/error.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

Body two_regions() {
  Body body =
      test::make_block(test::even(0, 0.01, 1), test::even(0, 0.01, 1), test::even(0, 0.01, 1));
  body.region_names = {"skin", "fat"};
  return body;
}

std::string refusal(const std::vector<RegionMaterial>& materials) {
  try {
    laws_of_regions(two_regions(), materials);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "";
}

TEST(RegionLaws, AreInTheOrderOfTheRegions) {
  const auto laws = laws_of_regions(two_regions(), {{"fat", {5e3, 0.45}}, {"skin", {50e3, 0.45}}});
  ASSERT_EQ(laws.size(), 2u);
  const Lanes J = Lanes::Constant(1);
  EXPECT_NEAR(laws[0].pressure_slope(J)[0], 10 * laws[1].pressure_slope(J)[0], 1e-6);
}

TEST(RegionLaws, RefuseRegionsWithoutOneValidLawEach) {
  using testing::HasSubstr;
  const RegionMaterial skin{"skin", {5e4, 0.45}}, fat{"fat", {5e3, 0.45}};
  EXPECT_EQ(refusal({skin, fat}), "");
  EXPECT_THAT(refusal({skin}), HasSubstr("region 'fat'"));
  EXPECT_THAT(refusal({skin, fat, fat}), HasSubstr("2 materials"));
  EXPECT_THAT(refusal({skin, fat, {"bone", {1e6, 0.3}}}), HasSubstr("skin, fat"));
  EXPECT_THAT(refusal({skin, {"fat", {-1, 0.45}}}), HasSubstr("young"));
}

}  // namespace
}  // namespace palpate::fem
