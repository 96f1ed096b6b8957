// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/sizing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(GradedSize, IsTheLeastOfAllSourcesWithTheirGrowth) {
  std::vector<SizeSource> sources;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.1 * i;
    sources.push_back({{std::cos(3 * t), std::sin(5 * t), std::cos(7 * t)},
                       0.01 + 0.05 * (1 + std::sin(11 * t))});
  }
  const GradedSize graded(sources, 0.3);
  for (int i = 0; i < 100; ++i) {
    const Vec3 x{std::sin(1.0 * i), std::cos(2.0 * i), std::sin(3.0 * i)};
    double least = 1e9;
    for (const SizeSource& s : sources) least = std::min(least, s.size + 0.3 * norm(x - s.point));
    EXPECT_NEAR(graded.at(x), least, 1e-12);
  }
}

TEST(SurfaceSizes, FollowTheThicknessOfAPlateAndOfItsLayers) {
  Domain domain;
  domain.skin = test::box({0, 0, 0}, {1, 1, 0.1});
  domain.region_names = {"matrix", "film"};
  const SizingSettings settings{[](const Vec3&) { return 0.2; }, 0.01, 0.7};
  const auto plate = surface_sizes(domain, settings);
  const auto flat = std::count_if(plate.begin(), plate.end(), [](const SizeSource& s) {
    return std::abs(s.size - 0.07) < 1e-4;
  });
  EXPECT_GT(flat, 0.8 * static_cast<double>(plate.size()));
  domain.layers = {{0.02, 1}};
  for (const SizeSource& source : surface_sizes(domain, settings))
    EXPECT_LE(source.size, 0.02 + 1e-12);
}

TEST(SurfaceSizes, LeaveAThickBodyAlone) {
  Domain domain;
  domain.skin = test::sphere({0, 0, 0}, 0.5, 48);
  for (const SizeSource& source :
       surface_sizes(domain, {[](const Vec3&) { return 0.1; }, 0.01, 0.7}))
    EXPECT_EQ(source.size, 0.1);
}

}  // namespace
}  // namespace palpate::mesher
