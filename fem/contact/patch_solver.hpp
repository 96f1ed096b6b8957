// SPDX-License-Identifier: AGPL-3.0-or-later
// The contact on a condensed solid: a small dense problem.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/contact/contact_patch.hpp"

namespace palpate::fem {

/// The stiffness of the solid condensed onto the patch, N/m, numbered as the patch. A compressed
/// body is often stable only against its tool, and S indefinite: as much of `stiffening` as needed
/// is then added to its diagonal.
struct PatchStiffness {
  Eigen::MatrixXd S;
  Eigen::VectorXd stiffening;
};

/// The minimum over d of d S d/2 - load . d + E_c(d), by Newton's method.
///
/// The contact acts on some of the unknowns of the patch only. The others are eliminated, which
/// serves all minima with the same S, and Newton's method runs on this core: E_c changes in every
/// iteration, and each costs a dense factorization. Where the tool meets a facet outside, its
/// unknowns join the core.
class PatchSolver {
 public:
  /// S of the next minima; it must outlive them, and a change must be announced by another call.
  void use(const PatchStiffness& stiffness);

  /// The core is to have the unknowns that the contact touches at d.
  void expect(const ContactPatch& patch, const ToolContact& contact, const Eigen::VectorXd& d) {
    patch.mark_touched(contact, d, in_core_);
  }

  /// From `d`, until the gradient is within `tolerance`, N, or within what rounding to single
  /// precision leaves of it, some 1e-6. Nothing where the model is not convex with all of the
  /// stiffening either.
  std::optional<Eigen::VectorXd> minimum(const ContactPatch& patch, const ToolContact& contact,
                                         const Eigen::VectorXd& load, Eigen::VectorXd d,
                                         double tolerance);

 private:
  /// Eliminates the unknowns outside the core from S, of which this fraction of the stiffening is
  /// added to the diagonal, in single precision; false where that is not positive definite.
  bool condense(std::size_t fraction);
  /// The lower triangle of S, those outside the core first.
  void gather_in_order();
  /// The fraction to try where this one does not make the model convex.
  std::size_t stiffer_than(std::size_t fraction) const;
  /// False where the model is not convex; d is then where that was found.
  bool minimize_on_core(const ContactPatch& patch, const ToolContact& contact,
                        const Eigen::VectorXd& load, double tolerance, Eigen::VectorXd& d);
  /// Minimizes d S d/2 - load . d + E_c(d), all on the core. Returns as above.
  bool minimize(const PatchContact& core, const ToolContact& contact, const Eigen::VectorXd& load,
                double tolerance, Eigen::VectorXd& d);
  /// Factorizes S and the Hessian of the contact, in single precision, which takes half the time;
  /// without the geometric term of the contact, which can be negative, where that fails. False when
  /// both fail.
  bool factorize(const PatchContact& core, const ToolContact& contact, const Eigen::VectorXd& d);
  /// -H^-1 g with the last factor.
  Eigen::VectorXd newton_step(const Eigen::VectorXd& g) const;

  Eigen::Index size() const { return static_cast<Eigen::Index>(order_.size()); }
  Eigen::Index core_size() const { return size() - rest_; }

  const PatchStiffness* stiffness_ = nullptr;
  std::vector<char> in_core_;            ///< (unknowns of the patch)
  std::vector<char> condensed_;          ///< in_core_ at the last condense()
  std::size_t fraction_ = 0;             ///< of the last condense()
  std::size_t next_fraction_ = 0;        ///< to begin with: of S none, then what sufficed
  std::size_t sufficient_fraction_ = 0;  ///< of the last minimum with any, of this S or another
  std::vector<int> order_;               ///< unknowns of the patch: those outside the core first
  std::vector<int> core_index_;          ///< of the unknowns of the patch, -1: outside
  Eigen::Index rest_ = 0;                ///< how many are outside
  Eigen::MatrixXf eliminated_;           ///< in that order, see eliminate_first()
  Eigen::MatrixXd S_;                    ///< of the core, lower triangle
  Eigen::MatrixXf single_S_;             ///< S_ in single precision
  Eigen::MatrixXf factor_;               ///< of S_ and the contact, at the last factorize()
  bool factorized_ = false;              ///< whether factor_ is one with the present S_
};

}  // namespace palpate::fem
