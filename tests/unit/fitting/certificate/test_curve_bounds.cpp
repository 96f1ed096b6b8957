// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounds against dense sampling of the curves, and their tightness at a sample.
#include "fitting/certificate/curve_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fitting/certificate/triangle_frame.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

constexpr int kSamples = 400;

double slope_of(const runtime::CompiledCurve& curve, double d) {
  constexpr double kStep = 1e-9;
  return (curve.force(d + kStep) - curve.force(d)) / kStep;
}

CurveTriple triple_of(const Library& library) {
  return {{runtime::CompiledCurve(library.responses[0].normal),
           runtime::CompiledCurve(library.responses[1].normal),
           runtime::CompiledCurve(library.responses[2].normal)},
          triangle_frame(library, 0).gradient};
}

Library random_library(std::mt19937& engine) {
  Library library = flat_triangle();
  for (int l = 0; l < 3; ++l) library.responses.push_back(random_response(engine, 0.4));
  return library;
}

TEST(CurveBounds, SlopesOfARangeAreThoseOfItsSamples) {
  std::mt19937 engine(71);
  std::uniform_real_distribution<double> u(0, 0.009);
  for (int trial = 0; trial < 40; ++trial) {
    const runtime::CompiledCurve curve(random_response(engine, 0.4).normal);
    const double a = u(engine), b = u(engine);
    const Range range{std::min(a, b), std::max(a, b)};
    const Range slopes = slope_range(curve, range);
    double least = 1e9, most = 0;
    for (int i = 0; i <= kSamples; ++i) {
      const double d = range.low + (range.high - range.low) * i / kSamples;
      const double slope = d > 0 ? curve.slope(d) : curve.slope_at_rest();
      least = std::min(least, slope);
      most = std::max(most, slope);
      EXPECT_NEAR(slope, slope_of(curve, d), 0.01);
    }
    EXPECT_LE(slopes.low, least + 1e-9);
    EXPECT_GE(slopes.high, most - 1e-9);
    // Exact: the samples come as close as the slope changes between two of them.
    const double spacing = (range.high - range.low) / kSamples;
    double bend = 0;
    for (const auto& piece : curve.pieces()) bend = std::max(bend, 2 * std::abs(piece.curvature));
    const double change = bend * spacing;
    EXPECT_NEAR(slopes.low, least, change + 1e-9);
    EXPECT_NEAR(slopes.high, most, change + 1e-9);
  }
}

TEST(CurveBounds, TheForceGradientBoundsThatOfEverySample) {
  std::mt19937 engine(72);
  for (int trial = 0; trial < 20; ++trial) {
    const Library library = random_library(engine);
    const CurveTriple triple = triple_of(library);
    const auto& gradient = triangle_frame(library, 0).gradient;
    const Range range{0.0005, 0.0075};
    const double bound = triple.force_gradient(range);
    double largest = 0;
    for (int i = 0; i <= kSamples; ++i) {
      const double d = range.low + (range.high - range.low) * i / kSamples;
      Vec3 g{};
      for (std::size_t l = 0; l < 3; ++l) g = g + triple.curves()[l].force(d) * gradient[l];
      largest = std::max(largest, norm(g));
    }
    EXPECT_GE(bound, largest * (1 - 1e-12));
    EXPECT_LE(bound, 1.5 * largest + 1e-9);
  }
}

TEST(CurveBounds, TheInverseEnclosesTheDeflectionsOfInterpolatedForces) {
  std::mt19937 engine(73);
  std::uniform_real_distribution<double> u(0, 1);
  for (int trial = 0; trial < 40; ++trial) {
    const CurveTriple triple = triple_of(random_library(engine));
    std::array<double, 3> low{}, high{};
    for (std::size_t l = 0; l < 3; ++l) {
      low[l] = 0.05 + 0.2 * u(engine);
      high[l] = low[l] + 0.1 * u(engine);
    }
    const Range range = triple.inverse(low, high);
    for (int k = 0; k < 50; ++k) {
      double a = u(engine), b = u(engine);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const std::array<double, 3> n{a, b, 1 - a - b};
      double wanted = 0;
      for (std::size_t l = 0; l < 3; ++l)
        wanted += n[l] * (low[l] + (high[l] - low[l]) * u(engine));
      double lower = 0, upper = 0.1;
      for (int i = 0; i < 80; ++i) {
        const double middle = 0.5 * (lower + upper);
        double f = 0;
        for (std::size_t l = 0; l < 3; ++l) f += n[l] * triple.curves()[l].force(middle);
        (f < wanted ? lower : upper) = middle;
      }
      EXPECT_GE(upper, range.low - 1e-12);
      EXPECT_LE(lower, range.high + 1e-12);
    }
  }
}

TEST(CurveBounds, TheEnergyRatioIsFiniteAtZeroAndBoundsEverySample) {
  std::mt19937 engine(74);
  for (int trial = 0; trial < 20; ++trial) {
    const Library library = random_library(engine);
    const CurveTriple triple = triple_of(library);
    const auto& gradient = triangle_frame(library, 0).gradient;
    const double bound = triple.energy_ratio({0, 0.008});
    ASSERT_TRUE(std::isfinite(bound));
    for (int i = 1; i <= kSamples; ++i) {
      const double d = 0.008 * i / kSamples;
      Vec3 g{};
      for (std::size_t l = 0; l < 3; ++l) g = g + triple.curves()[l].energy(d) * gradient[l];
      EXPECT_LE(norm(g) / triple.greatest_force(d), bound * (1 + 1e-12));
    }
  }
}

/// Bernstein coefficients of a cubic from its values at four points an equal distance apart.
std::array<double, 4> bernstein(const std::array<double, 4>& p) {
  return {p[0], (-5 * p[0] + 18 * p[1] - 9 * p[2] + 2 * p[3]) / 6,
          (2 * p[0] - 9 * p[1] + 18 * p[2] - 5 * p[3]) / 6, p[3]};
}

TEST(CurveBounds, TheEnergyRatioIsThatOfTheHullOfTheCubics) {
  // The first vertex stores more until the others have become stiffer: where the forces are equal,
  // within the first of four cells, the energies differ most.
  Library library = flat_triangle();
  const ResponseCurve stiffening{{0.0F, 0.002F, 0.008F}, {50, 300, 300}};
  library.responses.assign(3, node_response(stiffening, stiffening));
  library.responses[0].normal = {{0.0F, 0.002F, 0.008F}, {300, 100, 100}};
  const CurveTriple triple = triple_of(library);
  const Range range{0.0021, 0.0029};
  const double more = triple.curves()[0].energy(0.00225) - triple.curves()[1].energy(0.00225);
  double expected = 0, cell = (range.high - range.low) / 4;
  for (int k = 0; k < 4; ++k) {
    const double low = range.low + k * cell;
    std::array<double, 4> difference{};
    for (std::size_t i = 0; i < 4; ++i) {
      const double d = low + static_cast<double>(i) * cell / 3;
      difference[i] = triple.curves()[0].energy(d) - triple.curves()[1].energy(d);
    }
    for (const double b : bernstein(difference))
      expected = std::max(expected, std::abs(b) / triple.least_force(low));
  }
  const double along = norm(triangle_frame(library, 0).gradient[0]);
  EXPECT_NEAR(triple.energy_ratio(range), expected * along, 1e-9 * expected * along);
  EXPECT_GT(triple.energy_ratio(range), more * along / triple.least_force(0.00225));
}

TEST(CurveBounds, CellsCoverTheRangeWithoutAKnotInside) {
  std::mt19937 engine(75);
  const CurveTriple triple = triple_of(random_library(engine));
  const std::vector<double> ends = triple.cells({0, 0.009}, 3);
  EXPECT_EQ(ends.front(), 0);
  EXPECT_EQ(ends.back(), 0.009);
  for (const auto& curve : triple.curves())
    for (const auto& piece : curve.pieces())
      for (std::size_t k = 0; k + 1 < ends.size(); ++k)
        EXPECT_FALSE(ends[k] < piece.start && piece.start < ends[k + 1]);
}

}  // namespace
}  // namespace palpate::fitting
