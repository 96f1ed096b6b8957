// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fem/contact/contact.hpp"
#include "fem/contact/patch_solver.hpp"
#include "fem/factor/partial_factor.hpp"
#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

struct NewtonOptions {
  double tolerance = 1e-4;     ///< |residual| over |tool force|
  double least_force = 1e-12;  ///< N, in place of a smaller tool force
  int max_iterations = 40;
  double round_off = 0;  ///< N, residual that counts as none
  /// Reuse the factor while it converges well (modified Newton).
  bool reuse_factor = false;
};

struct NewtonResult {
  bool converged = false;
  int iterations = 0;
  std::string reason;  ///< of a failure, one clause; else empty
  /// State of the body at the solution, where the last evaluation knew it.
  std::optional<SolidModel::State> solid;
};

/// Energy of body and contact at a displacement, with its gradient on the unknowns of the model.
struct Equilibrium {
  double energy = 0;
  double min_J = 1;         ///< the other members are void when it is not positive
  SolidModel::State solid;  ///< with multipliers that of the augmented laws
  Eigen::VectorXd residual;
};
/// The residual that is compared with `options.tolerance`, N: its norm; for a body on springs,
/// which has no fixed node to take the resultant, at least the norm of its sum. 0 up to
/// `options.round_off`: without contact there is no tool force to compare with.
double imbalance(const SolidModel& model, const Eigen::VectorXd& residual, double round_off);
Equilibrium evaluate(const SolidModel& model, const ToolContact& contact, const Displacement& u,
                     const DilatationMultipliers* multipliers = nullptr);

/// Minimizes the energy of body and contact over the unknowns of a model. Each iteration replaces
/// the solid by its quadratic model, with a Cholesky factorization of its tangent A, and leaves the
/// contact nonlinear:
///   min over d of r . d + d A d / 2 + E_c(u + d),   r the internal forces.
/// E_c depends only on the unknowns of the contact patch P. The others are eliminated, which leaves
/// the Schur complement S, and the minimum is found by Newton's method on P, dense and small:
///   min r'_P . d_P + d_P S d_P / 2 + E_c(d_P),   r' the load condensed to P.
/// Facets that come into contact or leave it thus need no factorization. After a long step of a
/// nearly incompressible solid its pressures are far from those of the equilibrium, and A with them
/// can be indefinite: A has those that the step foretold, as where pressures are unknowns of their
/// own [Magisano, Leonetti & Garcea 2017]. A compressed solid is
/// often stable only against its tool, and S indefinite: see PatchSolver. Steps are
/// shortened until det F > 0 everywhere and the energy or the residual decreases, and lengthened
/// where the energy falls along a straight line: a part of the body snaps to another equilibrium. A
/// failure is a return value: u is then the last admissible iterate. One thread.
class NewtonSolver {
 public:
  /// `permutation`: elimination order for the pattern of the model, see Cholesky. `fastest`: in
  /// single precision factors cost half and steps are a little off; where they would be off by more
  /// than a few percent the factor is computed in double precision all the same. `fronts`: see
  /// PartialFactor.
  explicit NewtonSolver(const SolidModel& model, const std::vector<int>* permutation = nullptr,
                        const DilatationMultipliers* multipliers = nullptr,
                        Precision fastest = Precision::Double, SharedFronts* fronts = nullptr)
      : model_(model),
        permutation_(permutation),
        multipliers_(multipliers),
        fronts_(fronts),
        fastest_(fastest) {}

  /// Each solve goes on from the equilibrium of the last one, if any: see start_path().
  NewtonResult solve(const ToolContact& contact, const NewtonOptions& options, Displacement& u);

  /// To be called where the next solve starts from another equilibrium than the last one found.
  void start_path() { last_state_.resize(3, 0); }

 private:
  NewtonResult descend(const ToolContact& contact, const NewtonOptions& options, Displacement& u);
  /// `factor_is_kept`: a smaller patch would not be worth another factor.
  void choose_patch(const ToolContact& contact, const Displacement& u, bool factor_is_kept);
  bool factorize(const ToolContact& contact, const Displacement& u);
  bool factorize_as_precisely_as_needed();
  /// The error of the solution of a test load with the patch held, over that solution.
  double error_of_solution();
  /// K_ = A(u), its diagonal raised by the fraction `raised`.
  void raised_stiffness(const Displacement& u, double raised);
  /// The minimizer of the model above, to a residual of `tolerance`, N, on the patch; nothing where
  /// the model is not convex with the largest stiffening either.
  std::optional<Eigen::VectorXd> direction(const ToolContact& contact, const Displacement& u,
                                           const Eigen::VectorXd& residual, double tolerance);
  /// Moves u along d; false when no admissible step is found. A step with a factor of another state
  /// is admissible as a whole only, and where its model foretells the energy.
  bool line_search(const ToolContact& contact, const Eigen::VectorXd& d, bool stale,
                   Equilibrium& now, Displacement& u);
  /// Doubles a step of length 1 from `from`, whose result is in u and now, while the energy falls,
  /// on until it bends up. `energy` and `slope` are those at `from`.
  void lengthen(const ToolContact& contact, const Eigen::VectorXd& d, const Displacement& from,
                double energy, double slope, Equilibrium& now, Displacement& u) const;

  /// Index into the patch of the i-th of the unknowns that the factor keeps.
  Eigen::Index in_patch(Eigen::Index i) const {
    return index_in_patch_[static_cast<std::size_t>(i)];
  }

  const SolidModel& model_;
  const std::vector<int>* permutation_;
  const DilatationMultipliers* multipliers_;
  SharedFronts* fronts_;
  std::optional<ContactPatch> patch_;
  Precision fastest_,
      precision_ = Precision::Double;  ///< asked for; of the factors with this patch
  bool precision_is_checked_ = false;
  std::optional<PartialFactor> factor_;
  std::vector<double> K_;
  std::vector<int> index_in_patch_;  ///< of the unknowns that the factor keeps
  PatchStiffness patch_stiffness_;
  PatchSolver patch_solver_;
  bool factorized_ = false;
  Eigen::Vector3d tip_of_factor_ = Eigen::Vector3d::Zero();  ///< of the tool at that time, m
  /// Whose pressures foretell those of the next tangent: the state before the last step, or the
  /// last equilibrium; no columns: none yet.
  Displacement last_state_;
};

}  // namespace palpate::fem
