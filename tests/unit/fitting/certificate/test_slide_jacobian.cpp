// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/slide_jacobian.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/unit/fitting/certificate/plain_model.hpp"

namespace palpate::fitting {
namespace {

/// How many random states of random triangles, which `shape` makes of another kind, have steps as
/// steep as `fraction` of the bound of the state. None is steeper than the bound.
template <class Shape>
int steep_states(std::mt19937& engine, int trials, double fraction, const Shape& shape) {
  int alike = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Library library = random_triangle(engine, 0.06, 0.2);
    shape(library);
    const double mu = 0.1 + 0.2 * (trial % 3);
    const ContactElement element = contact_element(library, 0, 0.008, mu);
    const PlainModel model(library, 0);
    const SlidingState state = random_slide(engine, model, element);
    const double expected = SlideJacobian(element).bound(state.cell);
    EXPECT_TRUE(std::isfinite(expected));
    const double found = steepest_step(engine, model, state.start, mu);
    EXPECT_LE(found, expected * (1 + 1e-4)) << "trial " << trial;
    alike += found > fraction * expected ? 1 : 0;
  }
  return alike;
}

TEST(SlideJacobian, OfOneStateIsTheLargestForceGradientOfASlide) {
  std::mt19937 engine(45);
  for (const double most_lean : {0.0, 0.15}) {
    for (const bool coupled : {false, true}) {
      // The others soften as they slide: M_0 is steeper. |A|^2 is no eigenvalue.
      const int alike = steep_states(engine, 60, 0.98 - most_lean, [&](Library& library) {
        if (coupled) couple(library, engine, 0.3);
        lean(library, engine, most_lean);
      });
      EXPECT_GT(alike, 50) << "coupled " << coupled << ", lean " << most_lean;
    }
  }
}

TEST(SlideJacobian, OfOneStateWithSoftAxesIsTheLargestForceGradientOfASlide) {
  std::mt19937 engine(46);
  for (const double most_lean : {0.0, 0.15}) {
    const int alike = steep_states(engine, 120, 0.97, [&](Library& library) {
      couple(library, engine, 0.3);
      lean(library, engine, most_lean);
      soften(library, engine, 0.5);
    });
    EXPECT_GT(alike, 80) << "lean " << most_lean;
  }
}

TEST(SlideJacobian, NoStateOfACellIsSteeperThanItsBound) {
  std::mt19937 engine(47);
  std::uniform_real_distribution<double> u(0, 1);
  int cells = 0;
  double closest = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Library library = random_triangle(engine, 0.1, 0.3);
    if (trial % 2 == 1) couple(library, engine, 0.1);
    if (trial % 3 == 0) lean(library, engine, 0.1);
    if (trial % 4 == 1) soften(library, engine, 0.4);
    const ContactElement element = contact_element(library, 0, 0.008, 0.1 + 0.2 * (trial % 3));
    const SlideJacobian jacobian(element);
    SlideCell cell;
    for (SlideCell::Natural& n : cell.part) {
      const double a = 0.3 + 0.2 * u(engine), b = 0.2 + 0.2 * u(engine);
      n = {a, b, 1 - a - b};
    }
    const double azimuth = 2 * M_PI * u(engine), width = 0.4 * u(engine);
    cell.azimuth = {azimuth, azimuth + width};
    const std::vector<double> depths = element.depth_cells();
    const double z = depths[1] + 0.3 * (depths[2] - depths[1]) * u(engine);
    cell.z = {z, z + 0.3 * (depths[2] - depths[1])};
    cell.reach = {cell.z.low, element.depth};
    const double bound = jacobian.bound(cell);
    if (std::isinf(bound)) continue;
    ++cells;
    for (int i = 0; i < 100; ++i) {
      double p = u(engine), q = u(engine);
      if (p + q > 1) p = 1 - p, q = 1 - q;
      SlideCell::Natural n{};
      for (std::size_t l = 0; l < 3; ++l)
        n[l] = p * cell.part[0][l] + q * cell.part[1][l] + (1 - p - q) * cell.part[2][l];
      const double towards = cell.azimuth.low + width * u(engine);
      const double deep = cell.z.low + (cell.z.high - cell.z.low) * u(engine);
      const double reach = deep + (element.depth - deep) * u(engine);
      const double steep =
          jacobian.bound({{n, n, n}, {towards, towards}, {deep, deep}, {reach, reach}});
      EXPECT_LE(steep, bound * (1 + 1e-9));
      closest = std::max(closest, steep / bound);
    }
  }
  EXPECT_GT(cells, 100);
  EXPECT_GT(closest, 0.9);
}

TEST(SlideJacobian, OfALevelPlateOfAnyStiffnessIsThatAlongTheConeOfFriction) {
  // Equal springs k, slipping beyond their last knot: the force grows along n + mu t.
  constexpr double mu = 0.6;
  for (const double k : {0.25, 200.0}) {
    Library library = flat_triangle();
    set_equal_responses(library, node_response(linear_curve(k, 0.001), linear_curve(k, 0.001)));
    const ContactElement element = contact_element(library, 0, 0.008, mu);
    std::mt19937 engine(48);
    SlideCell cell = random_slide(engine, PlainModel(library, 0), element).cell;
    cell.z = cell.reach = {0.003, 0.003};
    EXPECT_NEAR(SlideJacobian(element).bound(cell), k * std::hypot(1.0, mu), 1e-9 * k);
  }
}

}  // namespace
}  // namespace palpate::fitting
