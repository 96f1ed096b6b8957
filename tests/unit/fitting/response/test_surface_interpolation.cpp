// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/surface_interpolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/fitting/plate_body.hpp"

namespace palpate::fitting {
namespace {

double interpolated(const SurfaceInterpolation& field, const std::vector<Vec3>& positions,
                    std::size_t at, const Field& value) {
  double sum = 0;
  for (const Donor& donor : field.weights(at)) sum += donor.weight * value(positions[donor.vertex]);
  return sum;
}

/// Vertex 0 at the origin, then a square grid of side `h` in which it lies off the nodes.
std::vector<Vec3> grid_around(double h, double x = 0.41, double y = 0.23) {
  std::vector<Vec3> positions{{0, 0, 0}};
  for (int j = -3; j <= 3; ++j)
    for (int i = -3; i <= 3; ++i) positions.push_back({(i + x) * h, (j + y) * h, 0});
  return positions;
}

std::vector<std::size_t> all_but_first(std::size_t count) {
  std::vector<std::size_t> donors;
  for (std::size_t v = 1; v < count; ++v) donors.push_back(v);
  return donors;
}

TEST(SurfaceInterpolation, IsExactForLinearFieldsOnAPlane) {
  const auto positions = grid_around(0.01);
  const std::vector<Vec3> inward(positions.size(), kInward);
  const SurfaceInterpolation field(positions, inward, all_but_first(positions.size()));
  const Field linear = [](const Vec3& x) { return 3 + 40 * x[0] - 70 * x[1]; };
  EXPECT_NEAR(interpolated(field, positions, 0, linear), 3, 1e-9);
}

TEST(SurfaceInterpolation, ErrorFallsAtLeastWithTheSquareOfTheSpacing) {
  const Field smooth = [](const Vec3& x) { return std::exp(30 * x[0]) * std::cos(50 * x[1]); };
  std::vector<double> errors;
  for (const double h : {0.01, 0.005, 0.0025}) {
    double sum = 0;
    for (const double shift : {0.1, 0.2, 0.3, 0.4, 0.5}) {
      const auto positions = grid_around(h, shift, 0.5 - shift);
      const std::vector<Vec3> inward(positions.size(), kInward);
      const SurfaceInterpolation field(positions, inward, all_but_first(positions.size()));
      sum += std::pow(interpolated(field, positions, 0, smooth) - smooth({0, 0, 0}), 2);
    }
    errors.push_back(std::sqrt(sum));
  }
  EXPECT_LT(errors[1], errors[0] / 3.5);
  EXPECT_LT(errors[2], errors[1] / 3.5);
}

TEST(SurfaceInterpolation, WeightsOfDonorsOnALineAreNotNegative) {
  std::vector<Vec3> positions{{0, 0.004, 0}};
  for (int i = -4; i <= 4; ++i) positions.push_back({0.01 * i, 0, 0});
  const std::vector<Vec3> inward(positions.size(), kInward);
  const SurfaceInterpolation field(positions, inward, all_but_first(positions.size()));
  double sum = 0;
  for (const Donor& donor : field.weights(0)) {
    EXPECT_GE(donor.weight, 0);
    sum += donor.weight;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(SurfaceInterpolation, IgnoresTheOtherSideOfAThinBody) {
  auto positions = grid_around(0.01);
  std::vector<Vec3> inward(positions.size(), kInward);
  const std::size_t one_side = positions.size();
  for (const Vec3& x : grid_around(0.01)) {
    positions.push_back(x + Vec3{0, 0, -0.002});
    inward.push_back({0, 0, 1});
  }
  const SurfaceInterpolation field(positions, inward, all_but_first(positions.size()));
  for (const Donor& donor : field.weights(0)) EXPECT_LT(donor.vertex, one_side);
}

}  // namespace
}  // namespace palpate::fitting
