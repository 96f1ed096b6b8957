// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "fem/cholesky.hpp"
#include "fem/contact.hpp"
#include "fem/solid_model.hpp"

namespace palpate::fem {

struct NewtonOptions {
  double tolerance = 1e-4;  ///< |residual| over |tool force|
  int max_iterations = 40;
  bool reuse_factor = false;  ///< keep the last factor while it contracts well (modified Newton)
};

struct NewtonResult {
  bool converged = false;
  int iterations = 0;
  std::string reason;  ///< of a failure, one clause
};

/// Energy of body and contact at a displacement, with its gradient on the unknowns of the model.
struct Equilibrium {
  double energy = 0;
  double min_J = 1;  ///< the rest is void when not positive
  Eigen::VectorXd residual;
};
Equilibrium evaluate(const SolidModel& model, const SphereContact& contact, const Displacement& u);

/// Minimises the energy of body and contact over the unknowns of a model, by Newton's method with a
/// Cholesky factorization. Steps are shortened until det F > 0 everywhere and the energy or the
/// residual decreases. A failure is a return value: u is then the last admissible iterate.
class NewtonSolver {
 public:
  /// `permutation`: elimination order for the pattern of the model, see Cholesky.
  explicit NewtonSolver(const SolidModel& model, const std::vector<int>* permutation = nullptr)
      : model_(model), factor_(model.pattern(), permutation) {}

  NewtonResult solve(const SphereContact& contact, const NewtonOptions& options, Displacement& u);

 private:
  bool factorize(const SphereContact& contact, const Displacement& u);
  /// Moves u along d; false when no admissible step is found.
  bool line_search(const SphereContact& contact, const Eigen::VectorXd& d, Equilibrium& now,
                   Displacement& u) const;

  const SolidModel& model_;
  Cholesky factor_;
  SolveWorkspace workspace_;
  std::vector<double> K_;
  bool factorized_ = false;
};

/// u += s d on the unknowns of the model.
void move(const SolidModel& model, double s, const Eigen::VectorXd& d, Displacement& u);

}  // namespace palpate::fem
