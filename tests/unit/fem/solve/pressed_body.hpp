// SPDX-License-Identifier: AGPL-3.0-or-later
// A block under a sphere, with what the solvers of a site are made of.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/contact/contact.hpp"
#include "fem/factor/cholesky.hpp"
#include "fem/solid/solid_model.hpp"
#include "fem/solve/shared_factor_solver.hpp"
#include "fem/solve/turned_factor.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {

inline constexpr double kYoung = 10e3, kToolRadius = 0.005;

struct PressedBody {
  explicit PressedBody(double window_radius, double poisson = 0.45,
                       Dilatation element = Dilatation::Mean)
      : whole(body, {NeoHookean::from_young_poisson(kYoung, poisson, "t")}, element),
        window(whole, Eigen::Vector3d::Zero(), window_radius),
        factor(whole.pattern()) {
    const DilatationMultipliers multipliers = whole.multipliers();
    std::vector<double> K;
    whole.stiffness(rest(), K, &multipliers);
    factor.factorize(K);
  }

  Displacement rest() const { return Displacement::Zero(3, whole.mesh().nodes()); }

  /// x = K0^-1 b, by a factor of this test's own.
  void rest_solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    x.resize(b.size());
    factor.solve(b.data(), x.data(), workspace);
  }

  /// The same with the stiffness turned as at u.
  SharedFactorSolver::RestSolve turned_solve(const Displacement& u) const {
    const auto turned = std::make_shared<TurnedFactor>(whole, nested_dissection(whole.pattern()),
                                                       Precision::Single, u);
    return [turned](const Eigen::VectorXd& b, Eigen::VectorXd& x) { turned->solve(b, x); };
  }

  /// The sphere with its tip at a depth below the top.
  void press(double depth) {
    Tool tool;
    tool.geometry.radius = kToolRadius;
    tool.tip = Eigen::Vector3d(3e-4, -2e-4, -depth);
    contact.move_to(tool);
  }

  Body body =
      test::make_block(test::graded(0.016, 0.005, 0.0025, 1.8),
                       test::graded(0.016, 0.005, 0.0025, 1.8), {-0.016, -0.007, -0.0025, 0});
  SolidModel whole, window;
  ToolContact contact{
      whole.mesh(), Eigen::Vector3d::Zero(), 0.012, {5000 * kYoung / kToolRadius, kYoung}};
  Cholesky factor;
  SolveWorkspace workspace;
};

}  // namespace palpate::fem
