// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <deque>
#include <functional>

#include "fem/solid/prolongation.hpp"
#include "fem/solve/multiplier_path.hpp"
#include "fem/solve/newton.hpp"

namespace palpate::fem {

/// Equilibrium without factorizing the stiffness of the body. A window around the tool, with the
/// contact and the large strains, is solved by Newton's method in every step. This leaves the
/// energy as a function of the displacement outside,
///   phi(u_o) = min over u_w of Pi(u_o, u_w),   grad phi = the residual outside.
/// It is nearly quadratic, and its Hessian at rest is the Schur complement S0 of the window; the
/// outer block of K0^-1 is S0^-1. phi is therefore minimized by L-BFGS [Nocedal & Wright 2006,
/// alg. 7.5] with K0^-1 as the initial inverse Hessian, a solve with the factor that all sites
/// share. One thread; the rest solve may be shared.
///
/// An ear or a lobe bends as a whole, and S0 is then far from the Hessian. An increment that takes
/// many steps goes on with a factor of its own, of the stiffness at rest that has turned with every
/// element, and all later increments do so after fewer steps.
///
/// Near incompressibility S0 knows nothing of how the constraint on the volume turns with the
/// deformation, and the number of steps would grow like kappa/mu. There the method of multipliers
/// [Nocedal & Wright 2006, sec. 17.3] minimizes Pi with the augmented laws of
/// DilatationMultipliers, and K0 is their stiffness. The multipliers step whenever the residual has
/// fallen enough below that after their last step, and the residual after the last of them is
/// judged.
class SharedFactorSolver {
 public:
  /// Largest number of curvature pairs, for a no-slip press, for a body on springs and for one that
  /// has bent.
  static constexpr std::size_t kMostPairs = 30;
  /// The number that suffices for most presses without friction. More pairs cost memory bandwidth.
  static constexpr std::size_t kFewPairs = 12;

  /// x = K0^-1 b on the unknowns of the whole body.
  using RestSolve = std::function<void(const Eigen::VectorXd& b, Eigen::VectorXd& x)>;

  /// Where the factor at rest does not serve.
  struct BentBody {
    /// The solve with the stiffness that has turned with the body at u; it lives as long as one
    /// increment needs it.
    std::function<RestSolve(const Displacement& u)> turned_solve;
    int after_steps;      ///< of an increment with the factor at rest
    int then_after;       ///< the same of all increments after that
    double least_energy;  ///< of the body at rest, J
  };

  /// `prolongation`: from the body that was factorized to the refined mesh of `whole` and `window`;
  /// phi is a function of the unknowns of the former. Null where no element is refined. `fronts`:
  /// for the factors of the window, see PartialFactor.
  SharedFactorSolver(const SolidModel& whole, const SolidModel& window, RestSolve rest_solve,
                     BentBody bent, std::size_t pairs, const Prolongation* prolongation = nullptr,
                     SharedFronts* fronts = nullptr)
      : whole_(whole),
        multipliers_(whole.multipliers()),
        newton_(window, nullptr, &multipliers_, Precision::Single, fronts),
        rest_solve_(std::move(rest_solve)),
        bent_(std::move(bent)),
        prolongation_(prolongation),
        most_pairs_(pairs) {}

  /// Moves `u` to the equilibrium. Reuses the window factor and the curvature pairs of the last
  /// call: successive calls should be neighbours on a path. A failure is a return value.
  NewtonResult solve(const ToolContact& contact, const NewtonOptions& options, Displacement& u);

  /// Discards the curvature pairs.
  void restart() { pairs_.clear(); }
  /// To be called at the start of a path from the equilibrium `u`, with the tip of the tool there.
  void start_path(const Eigen::Vector3d& tip, const Displacement& u);
  /// To be called where another solver has found the next equilibrium `u` of the path.
  void accept(const Eigen::Vector3d& tip, const Displacement& u);

 private:
  /// A step and the change of the residual. A preconditioner: single precision costs no accuracy.
  struct Pair {
    Eigen::VectorXf s, y;
    float sy;
  };

  /// The method of solve() with the present multipliers to start with.
  NewtonResult equilibrate(const ToolContact& contact, const NewtonOptions& options,
                           Displacement& u);
  NewtonResult descend(const ToolContact& contact, const NewtonOptions& options, Displacement& u);
  enum class Verdict { GoOn, Converged, Failed };
  /// Whether the equilibrium is good enough. Where the multipliers are due, they step before that,
  /// and `now` and the errors are those after it. `force`: of the tool, N.
  Verdict judge(const ToolContact& contact, const NewtonOptions& options, double force,
                Equilibrium& now, Displacement& u, NewtonResult& result);
  /// Estimate of the error of the tool force, relative to it.
  double force_error() const { return std::max(1.0, sensitivity_) * error_; }
  bool relax_window(const ToolContact& contact, const NewtonOptions& options, int most_steps,
                    Displacement& u, NewtonResult& result);
  void remember(const Eigen::VectorXd& s, const Eigen::VectorXd& y);
  Eigen::VectorXd direction(const Eigen::VectorXd& residual);
  /// From here on the increment has a factor of its own.
  void turn_factor(const Displacement& u);
  /// d = R K0^-1 R^T q: the stiffness at rest rotated with the body, as a whole or, with a factor
  /// of its own, by elements. q is overwritten.
  void solve_rotated(Eigen::VectorXd& q, Eigen::VectorXd& d) const;
  /// As evaluate(), the residual on the unknowns of phi.
  Equilibrium evaluated(const ToolContact& contact, const Displacement& u) const;
  void add_step(double length, const Eigen::VectorXd& d, Displacement& u) const;
  /// The step to begin with along a direction in which the energy falls with this slope.
  double longest_step(double energy, double slope) const;
  bool step(const ToolContact& contact, const NewtonOptions& options, const Eigen::VectorXd& d,
            Equilibrium& now, Displacement& u, NewtonResult& result);

  const SolidModel& whole_;
  DilatationMultipliers multipliers_;
  MultiplierPath multiplier_path_;
  NewtonSolver newton_;
  RestSolve rest_solve_;
  BentBody bent_;
  bool is_bent_ = false;    ///< whether an increment has needed the factor of its own
  RestSolve turned_solve_;  ///< of the present increment; empty: the shared factor serves
  const Prolongation* prolongation_;
  std::size_t most_pairs_;
  std::deque<Pair> pairs_;
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();  ///< R, mean of the body
  bool rotated_ = false;                                    ///< whether R differs enough from 1
  /// Change of the tool force in the last steps over the residual before them, both over the tool
  /// force: an estimate of the error of the force for a residual.
  double sensitivity_ = 1;
  double error_ = 0;                    ///< |residual| over |tool force| at the present iterate
  double error_after_multipliers_ = 0;  ///< force_error() after their last step
};

}  // namespace palpate::fem
