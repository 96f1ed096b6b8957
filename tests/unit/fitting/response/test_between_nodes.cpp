// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/between_nodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

constexpr int kCells = 10;
constexpr double kCell = 0.01;
constexpr double kDepth = 0.003;

using Field = std::function<double(double x, double y)>;

std::size_t vertex(int i, int j) {
  return static_cast<std::size_t>(j) * (kCells + 1) + static_cast<std::size_t>(i);
}

/// A sheet of squares, each cut along the same diagonal, whose normal stiffness is a field.
Library sheet(const Field& stiffness) {
  Library library;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) {
      const double x = kCell * i, y = kCell * j;
      library.positions.push_back({x, y, 0});
      library.inward.push_back({0, 0, -1});
      library.responses.push_back(node_response(linear_curve(stiffness(x, y)), linear_curve(100)));
    }
  const auto number = [](int i, int j) { return static_cast<std::int32_t>(vertex(i, j)); };
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      library.triangles.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      library.triangles.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  return library;
}

bool within(const Library& library, const Triangle& triangle, double margin) {
  for (const std::int32_t v : triangle) {
    const Vec3& x = library.positions[static_cast<std::size_t>(v)];
    if (std::min({x[0], x[1], kCells * kCell - x[0], kCells * kCell - x[1]}) < margin) return false;
  }
  return true;
}

double quadratic(double x, double y) {
  return 150 + 900 * x - 400 * y + 2e4 * x * x + 8e3 * x * y + 1e4 * y * y;
}

TEST(BetweenNodes, TheMeanOverEveryTriangleIsThatOfTheField) {
  const Library library = sheet(quadratic);
  const std::vector<double> factors = factors_between_nodes(library, kDepth);
  int seen = 0;
  for (const Triangle& triangle : library.triangles) {
    if (!within(library, triangle, 0.5 * kCell)) continue;
    double rendered = 0, raw = 0, exact = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(triangle[k]);
      const Vec3 &a = library.positions[v],
                 &b = library.positions[static_cast<std::size_t>(triangle[(k + 1) % 3])];
      raw += quadratic(a[0], a[1]) / 3;
      rendered += factors[v] * quadratic(a[0], a[1]) / 3;
      // The mean of the middles of the edges is exact for a quadratic.
      exact += quadratic(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])) / 3;
    }
    EXPECT_NEAR(rendered, exact, 1e-5 * exact);  // responses are in single precision
    EXPECT_GT(raw - exact, 1e-3 * exact);
    ++seen;
  }
  EXPECT_EQ(seen, 2 * (kCells - 2) * (kCells - 2));
}

/// Mean square distance between the interpolated and the true stiffness at random points.
double mean_square(const Library& library, const Field& field, const std::vector<double>& factors) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  double sum = 0;
  int count = 0;
  for (const Triangle& triangle : library.triangles) {
    if (!within(library, triangle, 0.5 * kCell)) continue;
    for (int i = 0; i < 20; ++i, ++count) {
      double a = uniform(random), b = uniform(random);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const std::array<double, 3> natural{1 - a - b, a, b};
      double x = 0, y = 0, rendered = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(triangle[k]);
        const Vec3& corner = library.positions[v];
        x += natural[k] * corner[0];
        y += natural[k] * corner[1];
        rendered += natural[k] * factors[v] * field(corner[0], corner[1]);
      }
      sum += std::pow(rendered - field(x, y), 2);
    }
  }
  return sum / count;
}

TEST(BetweenNodes, TheErrorBetweenNodesFallsByMoreThanHalf) {
  // Stiffness that rises toward a support, as beside the fixed ends of a body: not quadratic.
  const Field field = [](double x, double) { return 150 + 100 * std::exp(-x / 0.03); };
  const Library library = sheet(field);
  const std::vector<double> one(library.positions.size(), 1.0);
  const double before = mean_square(library, field, one);
  const double after = mean_square(library, field, factors_between_nodes(library, kDepth));
  EXPECT_LT(std::sqrt(after), 0.5 * std::sqrt(before));
}

TEST(BetweenNodes, NothingIsScaledWhereTheStiffnessIsEven) {
  for (const double factor : factors_between_nodes(
           sheet([](double x, double y) { return 150 + 900 * x + 400 * y; }), kDepth))
    EXPECT_NEAR(factor, 1, 1e-5);
}

TEST(BetweenNodes, ASharpEdgeIsNoCurvature) {
  Library library = sheet([](double x, double) { return x < 0.045 ? 100 : 300; });
  for (std::size_t v = 0; v < library.positions.size(); ++v)
    if (library.positions[v][0] > 0.045) library.inward[v] = {-1, 0, 0};
  for (const double factor : factors_between_nodes(library, kDepth)) EXPECT_NEAR(factor, 1, 1e-5);
}

TEST(BetweenNodes, HolesAreLeftOut) {
  Library library = sheet(quadratic);
  const std::vector<double> whole = factors_between_nodes(library, kDepth);
  const std::size_t hole = vertex(5, 5);
  library.responses[hole] = {};
  const std::vector<double> factors = factors_between_nodes(library, kDepth);
  EXPECT_EQ(factors[hole], 1);
  for (std::size_t v = 0; v < factors.size(); ++v) EXPECT_TRUE(std::isfinite(factors[v]));
  EXPECT_NEAR(factors[vertex(2, 2)], whole[vertex(2, 2)], 1e-6);
}

}  // namespace
}  // namespace palpate::fitting
