// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <deque>
#include <functional>

#include "fem/solid/prolongation.hpp"
#include "fem/solve/newton.hpp"

namespace palpate::fem {

/// Equilibrium without factorizing the stiffness of the body. A window around the tool, which holds
/// the contact and the large strains, is solved by Newton's method at every step: what remains is
/// the energy as a function of the displacement outside,
///   phi(u_o) = min over u_w of Pi(u_o, u_w),   grad phi = the residual outside.
/// It is nearly quadratic, and its Hessian at rest is the Schur complement S0 of the window; the
/// outer block of K0^-1 is S0^-1. So phi is minimised by L-BFGS [Nocedal & Wright 2006, alg. 7.5]
/// that starts from K0^-1, a solve with the one factor that all sites share.
class SharedFactorSolver {
 public:
  /// Curvature pairs kept at most. A press that sticks and a body on springs need as many: with 6
  /// they take 1.4 and 2 times the steps.
  static constexpr std::size_t kMostPairs = 30;
  /// What is enough for a press without friction. More only cost memory traffic, of which two
  /// threads have no more than one.
  static constexpr std::size_t kFewPairs = 12;

  /// x = K0^-1 b on the unknowns of the whole body.
  using RestSolve = std::function<void(const Eigen::VectorXd& b, Eigen::VectorXd& x)>;

  /// `prolongation`: where the window has smaller elements than the body that was factorized, how
  /// their nodes follow its nodes; `whole` and `window` are then on the divided mesh. phi is a
  /// function of the body's own unknowns all the same. Null: one mesh.
  SharedFactorSolver(const SolidModel& whole, const SolidModel& window, RestSolve rest_solve,
                     std::size_t pairs, const Prolongation* prolongation = nullptr)
      : whole_(whole),
        newton_(window),
        rest_solve_(std::move(rest_solve)),
        prolongation_(prolongation),
        most_pairs_(pairs) {}

  /// The factor and curvature pairs of the last call are kept: successive calls should be
  /// neighbours on a path.
  NewtonResult solve(const ToolContact& contact, const NewtonOptions& options, Displacement& u);

  /// As NewtonSolver::work_between, by the factor of the window.
  std::optional<double> work_between(const ToolContact& contact, const Eigen::Vector3d& from,
                                     const Displacement& before, const Displacement& after) {
    return newton_.work_between(contact, from, before, after);
  }

  /// Forget the curvature pairs, as at the start of a path.
  void restart() { pairs_.clear(); }

 private:
  /// A step and what it changed of the residual. They precondition: single precision costs no
  /// accuracy.
  struct Pair {
    Eigen::VectorXf s, y;
    float sy;
  };

  bool relax_window(const ToolContact& contact, const NewtonOptions& options, Displacement& u,
                    NewtonResult& result);
  void remember(const Eigen::VectorXd& s, const Eigen::VectorXd& y);
  Eigen::VectorXd direction(const Eigen::VectorXd& residual);
  /// d = R K0^-1 R^T q: the stiffness at rest turned with the body. q is overwritten.
  void solve_turned(Eigen::VectorXd& q, Eigen::VectorXd& d) const;
  /// Its residual on the unknowns of the body.
  Equilibrium evaluated(const ToolContact& contact, const Displacement& u) const;
  void moved(double length, const Eigen::VectorXd& d, Displacement& u) const;
  bool step(const ToolContact& contact, const NewtonOptions& options, const Eigen::VectorXd& d,
            Equilibrium& now, Displacement& u, NewtonResult& result);

  const SolidModel& whole_;
  NewtonSolver newton_;
  RestSolve rest_solve_;
  const Prolongation* prolongation_;
  std::size_t most_pairs_;
  std::deque<Pair> pairs_;
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();  ///< R, of the whole body
  bool turned_ = false;                                 ///< whether R is worth the while
  /// Change of the tool force that the last steps made, over the residual that they answered, both
  /// over the tool force. A residual that is left is worth as much.
  double sensitivity_ = 1;
  double error_ = 0;  ///< |residual| over |tool force| at the present iterate
};

}  // namespace palpate::fem
