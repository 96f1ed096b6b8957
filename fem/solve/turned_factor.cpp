// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/turned_factor.hpp"

#include "format/error.hpp"

namespace palpate::fem {

TurnedFactor::TurnedFactor(const SolidModel& body, const std::vector<int>& permutation,
                           Precision precision, const Displacement& u)
    : factor_(body.pattern(), &permutation, {}) {
  std::vector<double> K;
  body.turned_stiffness(u, K);
  if (precision == Precision::Single && factor_.factorize(K, Precision::Single)) return;
  if (factor_.factorize(K, Precision::Double)) return;
  throw Error(ErrorKind::Internal, "stiffness factorization",
              "the stiffness at rest, turned with the body, is not positive definite",
              "report this with the case");
}

void TurnedFactor::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  Eigen::VectorXd none;
  factor_.solve_forward(b, none);
  factor_.solve_backward(none, x);
}

}  // namespace palpate::fem
