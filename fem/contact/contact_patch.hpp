// SPDX-License-Identifier: AGPL-3.0-or-later
// The contact as a function of the few unknowns that it depends on.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "fem/contact/contact.hpp"

namespace palpate::fem {

/// Round-off of an energy summed over the elements, relative.
inline constexpr double kEnergyNoise = 1e-14;

/// The facets in contact and those with a common node. Their free nodes are the unknowns of a small
/// dense problem; d below is a change of these unknowns. A patch made for one contact serves its
/// copies too, moved or bonded.
class ContactPatch {
 public:
  /// The patch at displacement u; without contact, around the facet nearest to the tool.
  ContactPatch(const ToolContact& contact, const SolidModel& model, const Displacement& u);

  /// False when a facet outside the patch is in contact.
  bool covers(const ToolContact& contact, const Displacement& u) const;

  /// The unknowns of the model that belong to the patch, ascending; empty when it has none there.
  const std::vector<int>& unknowns() const { return unknowns_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(unknowns_.size()); }

  /// d from one displacement to another.
  Eigen::VectorXd difference(const Displacement& from, const Displacement& to) const;

  /// The displacement that d is a change of.
  void start_from(const ToolContact& contact, const Displacement& u);
  double energy(const ToolContact& contact, const Eigen::VectorXd& d) const;
  /// Energy; g = dE/dd.
  double gradient(const ToolContact& contact, const Eigen::VectorXd& d, Eigen::VectorXd& g) const;
  /// H += d2E/dd2, in its lower triangle. `geometric` as in ToolContact::add_stiffness.
  void add_hessian(const ToolContact& contact, const Eigen::VectorXd& d, bool geometric,
                   Eigen::MatrixXd& H) const;
  /// N, of the tool on the body; the patch covers the contact.
  Eigen::Vector3d tool_force(const ToolContact& contact, const Eigen::VectorXd& d) const;

 private:
  struct Point {
    std::size_t index;         ///< in the contact
    std::array<int, 6> first;  ///< index into d of the first unknown of each node, -1: none
    Eigen::Vector3d x;         ///< at the start
  };
  struct Tie {
    std::size_t index;  ///< in the contact
    int first;          ///< as above
    Eigen::Vector3d x;  ///< at the start
  };

  Eigen::Vector3d position(const ToolContact& contact, const Point& point,
                           const Eigen::VectorXd& d) const;
  static Eigen::Vector3d position(const Tie& tie, const Eigen::VectorXd& d);

  std::vector<char> near_;       ///< (facets of the contact)
  std::map<int, int> first_of_;  ///< index into d of every node of these facets, -1: none
  std::vector<int> unknowns_;
  std::vector<Point> points_;
  std::vector<Tie> ties_;  ///< of the contact at the start
};

/// The stiffness of the solid condensed onto the patch, N/m, numbered as the patch. A compressed
/// body is often stable only against its tool, and S indefinite; S with `stiffening` on its
/// diagonal is positive definite.
struct PatchStiffness {
  Eigen::MatrixXd S;
  Eigen::VectorXd stiffening;
};

/// The minimum over d of d S d/2 - load . d + E_c(d), by Newton's method from `d` until the
/// gradient is within `tolerance`, N. `scratch` may have any size; its memory is reused between
/// calls.
Eigen::VectorXd patch_minimum(const ContactPatch& patch, const ToolContact& contact,
                              const PatchStiffness& stiffness, const Eigen::VectorXd& load,
                              Eigen::VectorXd d, double tolerance, Eigen::MatrixXd& scratch);

}  // namespace palpate::fem
