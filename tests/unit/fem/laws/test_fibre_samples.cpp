// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include "fem/laws/fibre_samples.hpp"
#include "format/error.hpp"

namespace palpate::fem {
namespace {

TEST(FibreSamples, TheNearestIsThatOfAllDistances) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> entry(-1, 1);
  const auto point = [&] { return Vec3{entry(random), entry(random), entry(random)}; };
  for (const int count : {1, 2, 3, 100}) {
    std::vector<FibreSample> all;
    for (int i = 0; i < count; ++i) all.push_back({point(), {1, 0, 0}, {}});
    const FibreSamples samples(all);
    for (int trial = 0; trial < 200; ++trial) {
      const Vec3 X = point();
      double least = 1e9;
      for (const FibreSample& sample : all) least = std::min(least, norm(sample.at - X));
      EXPECT_EQ(norm(samples.nearest(X).at - X), least);
    }
  }
}

TEST(FibreSamples, RefusesNoneAndOnesWithoutADirection) {
  const auto make = [](std::vector<FibreSample> samples) { FibreSamples made(std::move(samples)); };
  const Vec3 along{1, 0, 0};
  EXPECT_THROW(make({}), Error);
  EXPECT_THROW(make({FibreSample{{}, {}, {}}}), Error);
  EXPECT_THROW(make({FibreSample{{std::nan(""), 0, 0}, along, {}}}), Error);
}

}  // namespace
}  // namespace palpate::fem
