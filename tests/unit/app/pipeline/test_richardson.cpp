// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/richardson.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::app {
namespace {

TEST(Richardson, FindsOrderAndLimitOfAPowerOfTheSize) {
  for (const double order : {0.5, 1.0, 2.3, 4.0}) {
    const std::vector<double> sizes{4e-3, 3e-3, 2e-3, 1.3e-3};
    std::vector<double> values;
    for (const double h : sizes) values.push_back(0.2 + 0.05 * std::pow(h / 4e-3, order));
    const Extrapolation e = extrapolate(sizes, values);
    EXPECT_TRUE(e.trusted);
    EXPECT_NEAR(e.order, order, 1e-9);
    EXPECT_NEAR(e.value, 0.2, 1e-12);
    EXPECT_NEAR(e.error, 0.25, 1e-9);
  }
}

TEST(Richardson, DoesNotPretendWhereThereIsNoLaw) {
  const std::vector<double> sizes{4e-3, 2e-3, 1e-3};
  const Extrapolation wavy = extrapolate(sizes, {1.0, 1.2, 1.1});
  EXPECT_FALSE(wavy.trusted);
  EXPECT_TRUE(std::isnan(wavy.order));
  EXPECT_DOUBLE_EQ(wavy.value, 1.1);
  EXPECT_NEAR(wavy.error, 0.2 / 1.1, 1e-12);
  EXPECT_FALSE(extrapolate(sizes, {1.0, 1.1, 1.3}).trusted);  // it diverges
  EXPECT_FALSE(extrapolate(sizes, {1.0, 1.0, 1.0}).trusted);
  const Extrapolation gap = extrapolate(sizes, {1.0, std::nan(""), 1.3});
  EXPECT_FALSE(gap.trusted);
  EXPECT_TRUE(std::isnan(gap.value));
}

}  // namespace
}  // namespace palpate::app
