// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "fitting/measurement/relaxation/relaxation_problem.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/relaxation/sphere_record.hpp"

namespace palpate::calibrate {
namespace {

const RampAndHold kSphere{0.2, 1e-3, 0.4, {{0.35, 0.3}, {0.25, 6}}};

TEST(RelaxationProblem, HasTheTruthAsItsMinimum) {
  const std::vector<RelaxationRecord> records{record_on(kSphere, 30, 601, {})};
  const RelaxationProblem problem(records, {});
  const LeastSquares squares = problem.squares(2);
  ASSERT_EQ(squares.constants.size(), 6U);
  const std::vector<double> truth{0.2, 1.5, 0.35, 0.25, std::log(0.3), std::log(6.0)};
  std::vector<double> r(squares.residuals), J(6 * squares.residuals);
  ASSERT_TRUE(squares.model(truth.data(), r.data(), J.data()));
  for (const double residual : r) EXPECT_NEAR(residual, 0, 1e-4);
  // The model is linear in the force: f/F over the scale.
  const double scale = problem.models()[0].scale();
  EXPECT_NEAR(J[600 * 6], kSphere.force(30) / 0.2 / scale, 1e-3 / scale);
}

TEST(RelaxationProblem, HasNoValueWhereNothingIsLeftInTheLongTerm) {
  const std::vector<RelaxationRecord> records{record_on(kSphere, 30, 601, {})};
  const RelaxationProblem problem(records, {});
  const LeastSquares squares = problem.squares(2);
  const std::vector<double> beyond{0.2, 1.5, 0.7, 0.4, 0, 1};
  std::vector<double> r(squares.residuals);
  EXPECT_FALSE(squares.model(beyond.data(), r.data(), nullptr));
}

TEST(RelaxationProblem, SortsTheTermsByTime) {
  const std::vector<RelaxationRecord> records{record_on(kSphere, 30, 601, {})};
  const RelaxationProblem problem(records, {});
  std::vector<double> c{0.2, 1.5, 0.1, 0.2, 3, 1};
  problem.squares(2).canonical(c);
  EXPECT_EQ(c, (std::vector<double>{0.2, 1.5, 0.2, 0.1, 1, 3}));
}

TEST(RelaxationProblem, RefusesSettingsOutOfRange) {
  const std::vector<RelaxationRecord> records{record_on(kSphere, 30, 601, {})};
  const auto with = [](auto change) {
    RelaxationSettings settings;
    change(settings);
    return settings;
  };
  EXPECT_THROW(RelaxationProblem(records, with([](auto& s) { s.most_terms = 9; })), Error);
  EXPECT_THROW(RelaxationProblem(records, with([](auto& s) { s.exponent = 0; })), Error);
  EXPECT_THROW(RelaxationProblem(records, with([](auto& s) { s.times = {2, 1}; })), Error);
}

}  // namespace
}  // namespace palpate::calibrate
