// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "fem/contact.hpp"
#include "fem/linear_solver.hpp"
#include "fem/solid_model.hpp"

namespace palpate::fem {

struct NewtonOptions {
  double tolerance = 1e-4;  ///< |residual| over |tool force|
  int max_iterations = 40;
};

struct NewtonResult {
  bool converged = false;
  int iterations = 0;
  std::string reason;  ///< of a failure, one clause
};

/// Minimise the energy of body and contact from the displacement `u`, which is updated in place.
/// Newton steps by `solver`, by `fallback` where that fails; steps are shortened until det F > 0
/// everywhere and the energy or the residual decreases. A failure is a return value: u is then the
/// last admissible iterate.
class NewtonSolver {
 public:
  NewtonSolver(const SolidModel& model, SphereContact& contact, LinearSolver& solver,
               LinearSolver* fallback)
      : model_(model), contact_(contact), solver_(solver), fallback_(fallback) {}

  NewtonResult solve(const NewtonOptions& options, Displacement& u);

 private:
  struct Evaluation {
    double energy;
    double min_J;
    Eigen::VectorXd residual;  ///< d(energy)/du on the unknowns
  };

  Evaluation evaluate(const Displacement& u) const;
  bool direction(const Displacement& u, const Eigen::VectorXd& residual, double tolerance,
                 Eigen::VectorXd& d);
  /// Moves u along d; false when no admissible step is found.
  bool line_search(const Eigen::VectorXd& d, Evaluation& now, Displacement& u) const;

  const SolidModel& model_;
  SphereContact& contact_;
  LinearSolver& solver_;
  LinearSolver* fallback_;
  std::vector<double> K_;
};

/// u + s d on the unknowns.
Displacement moved(const QuadraticMesh& mesh, const Displacement& u, double s,
                   const Eigen::VectorXd& d);

}  // namespace palpate::fem
