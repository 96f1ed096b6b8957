// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/axis_equations.hpp"

#include <gtest/gtest.h>

#include "tests/unit/fitting/measurement/identify/moved_device.hpp"

namespace palpate::identify {
namespace {

TEST(AxisEquations, HoldForTheConstantsOfTheDeviceAtItsDelay) {
  const samples::MovedDevice d;
  const MotionRecord record = samples::moved(d, 1);
  const AxisEquations equations(record, samples::kLargestDelay);
  ASSERT_EQ(equations.axes(), std::vector<std::size_t>{0});  // of the frame along y
  EquationFit known;
  known.solution.resize(5);
  known.solution << d.mass[1], d.damping[1], d.friction[1], 0, 0;
  const Eigen::VectorXd misfit = equations.forces(d.delay) - equations.matrix() * known.solution;
  EXPECT_LT(misfit.norm(), 1e-3 * equations.forces(d.delay).norm());
  EXPECT_LT(equations.solve(d.delay).misfit, equations.solve(1.2 * d.delay).misfit);
  // Those of the square wave are not among them, and hold as well.
  const double jump = record.time[record.jump[30]];
  EXPECT_GT(jump, 0.5 * static_cast<double>(equations.block(equations.matrix().rows() - 1)));
  const Window window{jump + d.delay - 0.01, jump + d.delay + 0.01,
                      record.command[record.jump[30]][0] > 0 ? -1.0 : 1.0};
  const double force = TestFunction(window).integral_of_command(record, 0, d.delay);
  EXPECT_NEAR(equations.impulse_misfit(window, known, d.delay), 0,
              2e-3 * TestFunction(window).integral());
  EXPECT_NE(equations.impulse_misfit(window, known, d.delay + 1e-3), force);
}

}  // namespace
}  // namespace palpate::identify
