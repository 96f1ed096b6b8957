// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::fem {

/// The multipliers of the last equilibria of a path, at most four, extrapolated along the way of
/// the tool as the displacements are.
class MultiplierPath {
 public:
  /// The first equilibrium of a path, and the tip of the tool there, m.
  void start(const Eigen::Vector3d& tip, const std::vector<double>& multipliers);
  /// The next one.
  void add(const Eigen::Vector3d& tip, const std::vector<double>& multipliers);

  /// Those for the next tip of the tool. There must be a start.
  std::vector<double> predict(const Eigen::Vector3d& tip) const;
  /// Those of the last equilibrium.
  const std::vector<double>& last() const { return multipliers_.back(); }
  bool empty() const { return travel_.empty(); }

 private:
  double travel_to(const Eigen::Vector3d& tip) const {
    return travel_.back() + (tip - tip_).norm();
  }

  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero();
  std::vector<double> travel_;  ///< m, of the tool along the path
  std::vector<std::vector<double>> multipliers_;
};

}  // namespace palpate::fem
