// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/record/relaxation_at_rate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/contact_state.hpp"
#include "runtime/handles.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::app {
namespace {

Library plate_that_relaxes_in(double time) {
  return test::relaxing(
      test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); }), {time},
      true);
}

TEST(ShortRelaxationWarning, StandsWhereFivePeriodsAreLonger) {
  EXPECT_EQ(short_relaxation_warning(plate_that_relaxes_in(5.1e-3), 1000), "");
  EXPECT_THAT(short_relaxation_warning(plate_that_relaxes_in(4.9e-3), 1000),
              ::testing::HasSubstr("4.90 ms, is below five periods of the force loop at 1000 Hz"));
  EXPECT_EQ(
      short_relaxation_warning(
          test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); }), 1000),
      "");
}

/// The force at the end of a press, with the steps of a loop over that with steps a hundred times
/// shorter.
double error_of_steps(double time, double period) {
  const Library library = plate_that_relaxes_in(time);
  const palpate_library body(library);
  const auto press = [&](double dt) {
    runtime::ContactState contact(body.surface, body.tree, {0, 0});
    contact.step({0.022, 0.031, 1e-9}, 1e-12);
    const int steps = static_cast<int>(std::lround(10 * time / dt));
    for (int i = 1; i <= steps; ++i) contact.step({0.022, 0.031, -3e-3 * i / steps}, dt);
    return contact.observation().force[2];
  };
  return std::abs(press(period) / press(period / 100) - 1);
}

/// It is proportional to the period over the relaxation time, and below it.
TEST(ShortRelaxationWarning, IsAboutAnErrorOfTheForce) {
  for (const double time : {5e-3, 10e-3, 40e-3}) {
    EXPECT_LT(error_of_steps(time, 1e-3), 1e-3 / time) << time;
    EXPECT_NEAR(error_of_steps(time, 1e-3) / error_of_steps(2 * time, 1e-3), 2, 0.3) << time;
  }
}

}  // namespace
}  // namespace palpate::app
