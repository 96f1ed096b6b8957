// SPDX-License-Identifier: AGPL-3.0-or-later
// The linear equations of the motion along an axis, one for each window.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "fitting/measurement/identify/motion_record.hpp"
#include "fitting/measurement/identify/weak_form.hpp"

namespace palpate::identify {

struct EquationFit {
  Eigen::VectorXd solution, residual;
  double misfit = 0;  ///< sum of squares
};

/// Equations of the windows that end before the first jump of the command.
class AxisEquations {
 public:
  /// @param largest_delay  s: commands before the record are not known
  AxisEquations(const MotionRecord& record, double largest_delay);

  std::size_t size() const { return windows_.size(); }
  /// Columns: accelerations of axes(), velocities of axes(), sign of the velocity, position, one;
  /// each row times its weight.
  const Eigen::MatrixXd& matrix() const { return matrix_; }
  /// The excited axis, then the others that move.
  const std::vector<std::size_t>& axes() const { return axes_; }
  /// Number of the half second in which an equation begins.
  long block(Eigen::Index row) const;

  Eigen::VectorXd forces(double delay) const;
  EquationFit solve(double delay) const;  ///< by least squares

  /// Force of the commands less that of the solution, times the test function of any window, N s.
  double impulse_misfit(const Window& window, const EquationFit& fit, double delay) const;
  /// Standard deviation of impulse_misfit where nothing but noise contributes, N s.
  double impulse_deviation(const Window& window, const EquationFit& fit) const;

 private:
  Eigen::RowVectorXd row(const Window& window) const;

  const MotionRecord& record_;
  std::vector<Window> windows_;
  std::vector<std::size_t> axes_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd weights_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition_;
};

/// Largest distance between two positions along an axis, m.
double travel_of(const MotionRecord& record, std::size_t axis);

}  // namespace palpate::identify
