// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/triangle_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "format/error.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

TEST(TriangleFrame, NormalsOfASphereTurnByOneOverItsRadius) {
  constexpr double kRadius = 0.04;
  double last_excess = 1;
  for (const int level : {1, 2, 3}) {
    const Library library = sphere(kRadius, level);
    double largest = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < library.triangles.size(); ++m) {
      const TriangleFrame frame = triangle_frame(library, m);
      largest = std::max(largest, frame.kappa);
      smallest = std::min(smallest, frame.kappa);
      // u is radial, so n turns by 1/|U| over R, and |U| is the cosine of the opening at least.
      EXPECT_NEAR(frame.kappa, 1 / (kRadius * frame.least_length), 1e-6 / kRadius);
      EXPECT_NEAR(frame.least_length, frame.cos_theta, 1e-9);
      EXPECT_LT(frame.twist, 0.5 * frame.kappa);  // a sphere turns along the slide only
    }
    EXPECT_GE(smallest, 1 / kRadius * (1 - 1e-12));
    const double excess = largest * kRadius - 1;
    EXPECT_LT(excess, 0.4 * last_excess);  // second order in the edge length
    last_excess = excess;
  }
  EXPECT_LT(last_excess, 0.02);
}

TEST(TriangleFrame, TheTwistIsTheTurnAcrossTheSlideThatIsLargestOverItsDirections) {
  // u = N + A x in the plane, so that n turns by A tau along tau, and across it by (N x tau) . A
  // tau.
  std::mt19937 engine(24);
  std::uniform_real_distribution<double> rate(-2, 2);  // 1/m: angles of a few hundredths
  int twisted = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const double a11 = rate(engine), a12 = rate(engine), a21 = rate(engine), a22 = rate(engine);
    Library library = flat_triangle();
    for (std::size_t l = 0; l < 3; ++l) {
      const Vec3& x = library.positions[l];
      library.inward[l] = unit({a11 * x[0] + a12 * x[1], a21 * x[0] + a22 * x[1], -1});
    }
    double across = 0;
    for (int i = 0; i < 3600; ++i) {
      const double c = std::cos(M_PI * i / 3600), s = std::sin(M_PI * i / 3600);
      across = std::max(across, std::abs(-s * (a11 * c + a12 * s) + c * (a21 * c + a22 * s)));
    }
    const TriangleFrame frame = triangle_frame(library, 0);
    const double tilt = 2 * std::sin(0.5 * std::acos(frame.cos_theta));
    EXPECT_GE(frame.twist, std::min(frame.kappa, across) * (1 - 1e-3));
    EXPECT_LE(frame.twist, (across + tilt * frame.kappa) * (1 + 1e-3));
    twisted += across < 0.7 * frame.kappa ? 1 : 0;  // elsewhere kappa limits the bound
  }
  EXPECT_GT(twisted, 5);
}

TEST(TriangleFrame, GradientsReproduceALinearField) {
  const Library library = sphere(0.04, 1);
  const Vec3 slope{3, -2, 5};
  for (std::size_t m = 0; m < library.triangles.size(); ++m) {
    const TriangleFrame frame = triangle_frame(library, m);
    Vec3 gradient{};
    for (std::size_t l = 0; l < 3; ++l) {
      const Vec3& x = library.positions[static_cast<std::size_t>(library.triangles[m][l])];
      gradient = gradient + dot(slope, x) * frame.gradient[l];
    }
    for (const std::int32_t v : library.triangles[m]) {
      const Vec3 edge = library.positions[static_cast<std::size_t>(v)] -
                        library.positions[static_cast<std::size_t>(library.triangles[m][0])];
      EXPECT_NEAR(dot(gradient, edge), dot(slope, edge), 1e-12);
    }
  }
}

TEST(TriangleFrame, LeastLengthIsTheDistanceToTheTriangleOfDirections) {
  // Against a search over a fine grid of natural coordinates.
  std::mt19937 engine(23);
  std::normal_distribution<double> lean(0, 0.5);
  for (int trial = 0; trial < 30; ++trial) {
    Library library = flat_triangle();
    for (Vec3& u : library.inward) u = unit({lean(engine), lean(engine), -1});
    double least = 1;
    for (int i = 0; i <= 200; ++i) {
      for (int j = 0; j <= 200 - i; ++j) {
        const double a = i / 200.0;
        const double b = j / 200.0;
        least = std::min(least, norm(a * library.inward[0] + b * library.inward[1] +
                                     (1 - a - b) * library.inward[2]));
      }
    }
    if (least < 0.51) continue;
    const double exact = triangle_frame(library, 0).least_length;
    EXPECT_LE(exact, least + 1e-12);
    EXPECT_NEAR(exact, least, 1e-4);
  }
}

TEST(TriangleFrame, ARefusalSaysWhereTheTriangleIs) {
  Library library = flat_triangle();
  library.positions = {{0.001, 0.002, 0.003}, {0.004, 0.002, 0.003}, {0.001, 0.005, 0.006}};
  library.inward.assign(3, Vec3{0, 0, 1});  // out of the body
  try {
    triangle_frame(library, 0);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "response triangle 0 near (0.002, 0.003, 0.004) m");
  }
}

}  // namespace
}  // namespace palpate::fitting
