// SPDX-License-Identifier: AGPL-3.0-or-later
// The contact as a function of the few unknowns that feel it.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "fem/contact/contact.hpp"

namespace palpate::fem {

/// Round-off of an energy summed over the elements, relative.
inline constexpr double kEnergyNoise = 1e-14;

/// The facets in contact and those that share a node with them. Their free nodes are the unknowns
/// of a small dense problem; d below is a change of these unknowns. Made for one contact, it serves
/// its copies too, moved or bonded.
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
    std::array<int, 6> place;  ///< in d of the first unknown of each node, -1: none
    Eigen::Vector3d x;         ///< at the start
  };
  struct Tie {
    std::size_t index;  ///< in the contact
    int place;          ///< as above
    Eigen::Vector3d x;  ///< at the start
  };

  Eigen::Vector3d position(const ToolContact& contact, const Point& point,
                           const Eigen::VectorXd& d) const;
  Eigen::Vector3d slip(const ToolContact& contact, const Tie& tie, const Eigen::VectorXd& d) const;

  std::vector<char> near_;         ///< (facets of the contact)
  std::map<int, int> node_place_;  ///< of every node of them, -1: none
  std::vector<int> unknowns_;
  std::vector<Point> points_;
  std::vector<Tie> ties_;  ///< of the contact that the start was with
};

/// The solid as the patch feels it, N/m, numbered as the patch. Under pressure it is often stable
/// against its tool alone and S indefinite; S with `stiffening` on its diagonal is not.
struct PatchStiffness {
  Eigen::MatrixXd S;
  Eigen::VectorXd stiffening;
};

/// The minimum over d of d S d/2 - load . d + E_c(d), sought by Newton's method from `d` until the
/// gradient is within `tolerance`, N. `scratch` is of any size: it keeps its memory between calls.
Eigen::VectorXd patch_minimum(const ContactPatch& patch, const ToolContact& contact,
                              const PatchStiffness& stiffness, const Eigen::VectorXd& load,
                              Eigen::VectorXd d, double tolerance, Eigen::MatrixXd& scratch);

}  // namespace palpate::fem
