// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/region_laws.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/factor/cholesky.hpp"
#include "fem/solve/preload.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/equilibrium.hpp"

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

/// The supports carry the weight of every region. The internal forces of a body without supports
/// sum to zero, so that those on the fixed nodes are what the rest of the body rests on them.
TEST(RegionLaws, DensitiesOfTheRegionsAreCarriedByTheSupports) {
  Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, 0.04, 4));
  body.region_names = {"skin", "fat"};
  const auto is_fat = [](double z) { return z > 0.02; };
  for (std::size_t e = 0; e < body.tetrahedra.size(); ++e) {
    double z = 0;
    for (const auto node : body.tetrahedra[e]) z += 0.25 * body.nodes[to_index(node)][2];
    body.tetrahedron_region[e] = is_fat(z) ? 1 : 0;
  }
  CampaignSettings settings;
  settings.materials = {{"fat", {8e3, 0.45}, 920}, {"skin", {8e3, 0.45}}};
  settings.gravity = {{0, 0, -9.81}, 1100};
  const Gravity gravity = gravity_on(body, settings);
  EXPECT_EQ(gravity.region_density, (std::vector<double>{1100, 920}));
  const SolidModel model(body, laws_of_regions(body, settings.materials), Dilatation::Mean,
                         gravity);
  const Displacement u =
      equilibrium_under_weight(model, nested_dissection(model.pattern()), body.name);
  Body unsupported = body;
  unsupported.fixed_nodes.clear();
  const SolidModel loose(unsupported, laws_of_regions(body, settings.materials));
  Eigen::VectorXd f;
  loose.forces(u, f);
  const auto on_fixed = test::body_loads(model.mesh(), [&](const Eigen::Vector3d& X) {
    return Eigen::Vector3d(0, 0, -9.81 * (is_fat(X[2]) ? 920 : 1100));
  });
  double support = 0;
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (model.equation(node) < 0) support += f[loose.equation(node) + 2] - on_fixed(2, node);
  const double expected = 9.81 * 0.02 * 0.02 * (0.02 * 920 + 0.02 * 1100);
  EXPECT_NEAR(support, expected, 1e-8 * expected);
}

}  // namespace
}  // namespace palpate::fem
