// SPDX-License-Identifier: AGPL-3.0-or-later
// Equilibrium of a body with a part of its weight.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/factor/memory.hpp"
#include "fem/factor/partial_factor.hpp"
#include "fem/solid/solid_model.hpp"
#include "fem/solve/preload_progress.hpp"

namespace palpate::fem {

/// Minimizes the energy of body and weight by Newton's method, with a factorization in each step.
///
/// A slender body turns by large angles. A step along the tangents of these turns stretches the
/// body, which costs far more energy than the step gains; the next step takes the stretch back. A
/// search for a lower energy in every step would shorten the steps a hundredfold. A few steps in a
/// row are therefore accepted whatever their energy, and taken back where none of them lowers it
/// (watchdog) [Nocedal & Wright 2006, sec. 15.6].
///
/// After a long step the pressures of a nearly incompressible body are far from those of the
/// equilibrium, and its stiffness need not be positive definite though the equilibrium is stable.
/// The step then takes the pressures that the state before foretells for the geometric stiffness
/// (SolidModel::foretold_pressures). What it leads to is an equilibrium where the stiffness is
/// positive definite.
///
/// In equilibrium the residual is at most 1e-9 of the weight, or its rounding error where that is
/// larger: a slender body is so much stiffer along its axis than across it that the last digit of
/// the displacements stands for a force of more than 1e-8 of the weight.
/// Factors are in single precision, and steps are refined by their residuals [Higham 2002, ch. 12];
/// where that does not converge, as on a slender body, they are in double precision. The bits do
/// not depend on the threads of the factorizations.
class PartialWeight {
 public:
  /// `permutation`: elimination order of the model. `counter`: of the steps; may be null. All must
  /// outlive this.
  PartialWeight(const SolidModel& model, const std::vector<int>& permutation,
                const FactorResources& resources = {}, PreloadCounter* counter = nullptr);

  enum class Outcome {
    Found,
    Unstable,    ///< the stiffness is not positive definite
    Inverted,    ///< no step keeps det F > 0
    Unconverged  ///< no step lowers the energy, or there were too many of them
  };
  /// Moves u to equilibrium with `part` of the weight. Unless it is found, u is no equilibrium.
  /// @throws Error(Configuration) when a factorization needs more memory than it may use.
  Outcome equilibrate(double part, Displacement& u);

  int iterations() const { return iterations_; }  ///< of the last call
  /// The largest displacement of a node in the first step of the last call, m.
  double first_step() const { return first_step_; }

  /// The smallest eigenvalue of the stiffness at `u`, N/m, and where its mode is largest at rest,
  /// m. Nothing where the stiffness is not positive definite.
  struct WeakestMode {
    double stiffness;
    Eigen::Vector3d X;
  };
  std::optional<WeakestMode> weakest_mode(const Displacement& u);

 private:
  struct State {
    double energy, min_J;
    Eigen::VectorXd residual;
  };

  /// The factor of K_; false where it is not positive definite.
  bool factorize();
  bool factorize_in(Precision precision);
  /// d = K_^-1 load, with the factor of K_. False where K_ is not positive definite after all.
  bool solve(const Eigen::VectorXd& load, Eigen::VectorXd& d);
  bool refine(const Eigen::VectorXd& load, Eigen::VectorXd& d);
  void solve_once(const Eigen::VectorXd& load, Eigen::VectorXd& d);

  State evaluate(double part, const Displacement& u) const;
  bool is_stable(const Displacement& u);
  /// d; false where the stiffness is not positive definite.
  bool newton_step(const State& now, const Displacement& u, Eigen::VectorXd& d);
  bool is_equilibrium(const State& now, const Displacement& u);
  double rounding_error(const Displacement& u) const;
  /// Whether a step of this length from the checkpoint has lowered the energy or the residual.
  bool lowers(double length, const State& next) const;
  /// Move now and u; the outcome of a failure.
  std::optional<Outcome> free_step(double part, State& now, Displacement& u);
  std::optional<Outcome> step_from_checkpoint(double part, State& now, Displacement& u);

  const SolidModel& model_;
  Eigen::VectorXd weight_;
  double edge_;  ///< m, mean of the elements
  FactorResources resources_;
  PreloadCounter* counter_;
  PartialFactor factor_;
  Precision precision_ = Precision::Single;
  int threads_in_single_ = 0, threads_in_double_ = 0;  ///< 0: not yet chosen
  std::vector<double> K_;

  /// The state to which steps that lower nothing are taken back.
  struct Checkpoint {
    Displacement u;
    State state;
    Eigen::VectorXd d;  ///< Newton's step
  };
  Checkpoint checkpoint_;
  std::vector<double> foretold_;  ///< pressures of the present state, Pa; may be empty
  bool is_convex_ = true;         ///< whether the last step was with the stiffness of its state
  int free_steps_ = 0;            ///< since the checkpoint
  int iterations_ = 0;
  double first_step_ = 0;
};

}  // namespace palpate::fem
