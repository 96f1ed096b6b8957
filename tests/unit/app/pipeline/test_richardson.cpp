// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/richardson.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::app {
namespace {

TEST(Richardson, FindsOrderAndLimitOfAPowerOfTheSize) {
  for (const double order : {0.9, 1.0, 2.3, 3.9}) {
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
  EXPECT_NEAR(wavy.error, -0.1 / 1.1, 1e-12);
  EXPECT_NEAR(wavy.bound, (0.1 + 3 * 0.2) / 1.1, 1e-12);
  EXPECT_FALSE(extrapolate(sizes, {1.0, 1.1, 1.3}).trusted);  // it diverges
  EXPECT_FALSE(extrapolate(sizes, {1.0, 1.0, 1.0}).trusted);
  const Extrapolation gap = extrapolate(sizes, {1.0, std::nan(""), 1.3});
  EXPECT_FALSE(gap.trusted);
  EXPECT_TRUE(std::isnan(gap.value));
}

/// Orders that no element has come from chance.
TEST(Richardson, TrustsNoOrderOutOfRange) {
  for (const double order : {0.61, 5.34}) {
    std::vector<double> values;
    for (const double h : {4e-3, 2.8e-3, 2e-3})
      values.push_back(0.2 + 0.05 * std::pow(h / 4e-3, order));
    const Extrapolation e = extrapolate({4e-3, 2.8e-3, 2e-3}, values);
    EXPECT_FALSE(e.trusted) << order;
    EXPECT_GT(e.error, 0) << order;  // the sign is known nevertheless
    EXPECT_GT(e.bound, 0.05 / 0.2) << order;
  }
}

/// Errors of any order, with the scatter of a contact that falls on other parts of facets on every
/// mesh.
TEST(Richardson, BoundsTheErrorOfNearlyAllSequences) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  const std::vector<double> sizes{5e-3, 3.6e-3, 2.5e-3};
  int covered = 0;
  constexpr int kSequences = 2000;
  for (int i = 0; i < kSequences; ++i) {
    const double order = between(0.8, 4), error = between(-0.3, 0.3), scatter = between(0, 0.05);
    std::vector<double> values;
    for (const double h : sizes)
      values.push_back(1 + (error + scatter * between(-1, 1)) * std::pow(h / 5e-3, order));
    const Extrapolation e = extrapolate(sizes, values);
    covered += std::abs(values.front() - 1) <= e.bound * std::abs(e.value) ? 1 : 0;
  }
  EXPECT_GT(covered, 0.95 * kSequences);
}

TEST(Richardson, ForceOfZeroHasNoError) {
  const Extrapolation e = extrapolate({4e-3, 2.8e-3, 2e-3}, {0, 0, 0});
  EXPECT_FALSE(e.trusted);
  EXPECT_EQ(e.error, 0);
  EXPECT_EQ(e.bound, 0);
}

}  // namespace
}  // namespace palpate::app
