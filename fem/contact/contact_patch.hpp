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

/// Points and ties of a contact as functions of a change d of some unknowns.
class PatchContact {
 public:
  double energy(const ToolContact& contact, const Eigen::VectorXd& d) const;
  /// Energy; g = dE/dd.
  double gradient(const ToolContact& contact, const Eigen::VectorXd& d, Eigen::VectorXd& g) const;
  /// H += d2E/dd2, in its lower triangle. `geometric` as in ToolContact::add_stiffness.
  template <class Number>
  void add_hessian(const ToolContact& contact, const Eigen::VectorXd& d, bool geometric,
                   Eigen::MatrixX<Number>& H) const;

  /// Marks the unknowns of ties and of facets in contact.
  void mark_touched(const ToolContact& contact, const Eigen::VectorXd& d,
                    std::vector<char>& marks) const;
  /// The points and ties all of whose unknowns are among those with an index in `renumbered`, -1:
  /// none; in this numbering.
  PatchContact restricted_to(const std::vector<int>& renumbered) const;

 protected:
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

  std::vector<Point> points_;
  std::vector<Tie> ties_;  ///< of the contact at the start

 private:
  Eigen::Vector3d position(const ToolContact& contact, const Point& point,
                           const Eigen::VectorXd& d) const;
  static Eigen::Vector3d position(const Tie& tie, const Eigen::VectorXd& d);
};

/// The facets in contact and those with a common node. Their free nodes are the unknowns of a small
/// dense problem, see patch_solver.hpp. A patch made for one contact serves its copies too, moved
/// or bonded.
class ContactPatch : public PatchContact {
 public:
  /// The patch at displacement u; without contact, around the facet nearest to the tool.
  ContactPatch(const ToolContact& contact, const SolidModel& model, const Displacement& u);

  /// False when a facet outside the patch is in contact.
  bool covers(const ToolContact& contact, const Displacement& u) const;

  /// The unknowns of the model that belong to the patch, ascending; empty when it has none there.
  const std::vector<int>& unknowns() const { return unknowns_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(unknowns_.size()); }

  /// The displacement that d is a change of.
  void start_from(const ToolContact& contact, const Displacement& u);

 private:
  std::vector<char> near_;       ///< (facets of the contact)
  std::map<int, int> first_of_;  ///< index into d of every node of these facets, -1: none
  std::vector<int> unknowns_;
};

}  // namespace palpate::fem
