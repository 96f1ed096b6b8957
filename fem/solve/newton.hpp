// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fem/contact/contact.hpp"
#include "fem/contact/contact_patch.hpp"
#include "fem/factor/cholesky.hpp"
#include "fem/solid/solid_model.hpp"

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
/// What `options.tolerance` is held against, N: the norm of the residual, and on springs, where no
/// support takes what is left over, the sum of it. 0 where it is round-off of the weight: a tool
/// that meets nothing yet has no force to measure by.
double imbalance(const SolidModel& model, const Eigen::VectorXd& residual);
Equilibrium evaluate(const SolidModel& model, const ToolContact& contact, const Displacement& u);

/// Minimises the energy of body and contact over the unknowns of a model. Each iteration replaces
/// the solid by its quadratic model, with a Cholesky factorization of its tangent A alone, and
/// keeps the contact as it is:
///   min over d of r . d + d A d / 2 + E_c(u + d),   r the internal forces.
/// E_c sees the unknowns of the contact patch only. They are eliminated last, so that their Schur
/// complement S stands at the end of the factor and the minimum is found by Newton's method on
/// them, dense and small:  min r'_P . d_P + d_P S d_P / 2 + E_c(d_P),  r' the load condensed to P.
/// Facets that come into contact or leave it thus cost no factorization. A solid under pressure is
/// often stable against its tool alone, S indefinite: the diagonal of the patch is raised for the
/// factor, which raises that of S by as much, and lowered again in S. Steps are shortened until
/// det F > 0 everywhere and the energy or the residual decreases. A failure is a return value: u is
/// then the last admissible iterate.
class NewtonSolver {
 public:
  /// `permutation`: elimination order for the pattern of the model, see Cholesky.
  explicit NewtonSolver(const SolidModel& model, const std::vector<int>* permutation = nullptr)
      : model_(model), permutation_(permutation) {}

  NewtonResult solve(const ToolContact& contact, const NewtonOptions& options, Displacement& u);

  /// palpate::fem::work_between with S of the last factor; nothing where there is none.
  std::optional<double> work_between(const ToolContact& contact, const Eigen::Vector3d& from,
                                     const Displacement& before, const Displacement& after);

 private:
  void choose_patch(const ToolContact& contact, const Displacement& u);
  bool factorize(const Displacement& u);
  /// K_ = A(u), its diagonal raised by these parts of itself on the patch and everywhere.
  void shifted_stiffness(const Displacement& u, double patch, double all);
  /// The minimum of the model above, contact residual left: `tolerance`, N.
  Eigen::VectorXd direction(const ToolContact& contact, const Displacement& u,
                            const Eigen::VectorXd& residual, double tolerance);
  /// Moves u along d; false when no admissible step is found.
  bool line_search(const ToolContact& contact, const Eigen::VectorXd& d, Equilibrium& now,
                   Displacement& u) const;

  /// In the patch, of the i-th of the last unknowns of the factor.
  Eigen::Index place(Eigen::Index i) const { return last_place_[static_cast<std::size_t>(i)]; }

  const SolidModel& model_;
  const std::vector<int>* permutation_;
  std::optional<ContactPatch> patch_;
  std::optional<Cholesky> factor_;
  SolveWorkspace workspace_;
  std::vector<double> K_;
  std::vector<int> last_place_;     ///< in the patch, of the last unknowns of the factor
  Eigen::MatrixXd root_;            ///< lower triangular, of stiffened S in the order of the factor
  PatchStiffness patch_stiffness_;  ///< S itself, what the diagonal of A has in the factor
  Eigen::MatrixXd patch_scratch_;
  bool factorized_ = false;
};

}  // namespace palpate::fem
