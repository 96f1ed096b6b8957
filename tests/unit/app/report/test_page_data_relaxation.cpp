// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/report/page_data.hpp"
#include "tests/support/bodies.hpp"
#include "tests/unit/app/report/columns.hpp"

namespace palpate::report {
namespace {

constexpr std::int32_t kVertex = 40;  // in the middle of the plate

/// Half of the force relaxes, at 0.1 s and 2 s.
Library relaxing_plate() {
  return test::relaxing(
      test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); }), {0.1, 2},
      true);
}

double largest(const nlohmann::json& press) {
  const std::vector<float> force = floats(press.at("force"));
  return static_cast<double>(*std::max_element(force.begin(), force.end()));
}

TEST(RelaxationData, ShowsTheSamePressSlowerAndSofter) {
  const nlohmann::json data = relaxation_data(relaxing_plate(), kVertex);
  const double z = data.at("depth").get<double>();
  const double curve = z < 5e-3 ? 100 * 170 * z * z : 170 * (z - 2.5e-3);
  const nlohmann::json& presses = data.at("presses");
  EXPECT_NEAR(largest(presses.at(0)), curve, 0.02 * curve);        // fast: the curve
  EXPECT_NEAR(largest(presses.at(2)), 0.5 * curve, 0.02 * curve);  // slow: what is left
  EXPECT_LT(largest(presses.at(2)), largest(presses.at(1)));
  EXPECT_LT(largest(presses.at(1)), largest(presses.at(0)));
}

TEST(RelaxationData, ShowsAHeldPressThatFallsAsThePronySeries) {
  const nlohmann::json data = relaxation_data(relaxing_plate(), kVertex);
  const std::vector<float> time = floats(data.at("hold").at("time"));
  const std::vector<float> force = floats(data.at("hold").at("force"));
  for (std::size_t i = 0; i < time.size(); i += 50) {
    const double t = static_cast<double>(time[i]);
    EXPECT_NEAR(static_cast<double>(force[i] / force[0]),
                0.5 + 0.25 * std::exp(-t / 0.1) + 0.25 * std::exp(-t / 2), 1e-5)
        << t;
  }
}

TEST(RelaxationData, GivesTheRangeOfEachFraction) {
  const Library uneven = test::relaxing(
      test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); }), {0.1, 2},
      false);
  const nlohmann::json fractions = relaxation_data(uneven, kVertex).at("fractions");
  ASSERT_EQ(fractions.size(), 2U);
  EXPECT_LT(fractions[0].at("least").get<double>(), 0.2);
  EXPECT_GT(fractions[0].at("most").get<double>(), 0.3);
}

TEST(RelaxationData, IsNothingForElasticTissue) {
  const Library elastic =
      test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
  EXPECT_TRUE(relaxation_data(elastic, kVertex).is_null());
}

}  // namespace
}  // namespace palpate::report
