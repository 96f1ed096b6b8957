// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/axis_equations.hpp"

#include <algorithm>
#include <cmath>

#include "format/numbers.hpp"

namespace palpate::identify {
namespace {

constexpr double kStill = 0.02;  // of the motion of the excited axis: no motion

/// Noise of the positions enters the integral of phi'' x like length^-1.5.
double weight_of(const Window& window) {
  return std::pow(window.end - window.begin, 1.5);
}

std::vector<Window> windows_before_jumps(const MotionRecord& record, double margin) {
  std::vector<Window> windows = one_way_windows(record, margin);
  if (record.jump.empty()) return windows;
  const double end = record.time[record.jump.front()];
  std::erase_if(windows, [end](const Window& w) { return w.end > end; });
  return windows;
}

}  // namespace

double travel_of(const MotionRecord& record, std::size_t axis) {
  double low = kInfinity, high = -kInfinity;
  for (const Vec3& x : record.position)
    low = std::min(low, x[axis]), high = std::max(high, x[axis]);
  return record.position.empty() ? 0 : high - low;
}

AxisEquations::AxisEquations(const MotionRecord& record, double largest_delay)
    : record_(record), windows_(windows_before_jumps(record, largest_delay)) {
  const double travel = travel_of(record, record.axis);
  axes_.push_back(record.axis);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axis != record.axis && travel_of(record, axis) > kStill * travel) axes_.push_back(axis);
  const auto rows = static_cast<Eigen::Index>(windows_.size());
  matrix_.resize(rows, 2 * static_cast<Eigen::Index>(axes_.size()) + 3);
  weights_.resize(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Window& window = windows_[static_cast<std::size_t>(i)];
    weights_[i] = weight_of(window);
    matrix_.row(i) = weights_[i] * row(window);
  }
  if (rows > 0) decomposition_.compute(matrix_);
}

Eigen::RowVectorXd AxisEquations::row(const Window& window) const {
  const auto n = static_cast<Eigen::Index>(axes_.size());
  const TestFunction phi(window);
  Eigen::RowVectorXd row(2 * n + 3);
  for (Eigen::Index j = 0; j < n; ++j) {
    const std::size_t axis = axes_[static_cast<std::size_t>(j)];
    row[j] = phi.integral_of(record_, axis, 2);
    row[n + j] = -phi.integral_of(record_, axis, 1);
  }
  row[2 * n] = window.direction * phi.integral();
  row[2 * n + 1] = phi.integral_of(record_, record_.axis, 0);
  row[2 * n + 2] = phi.integral();
  return row;
}

long AxisEquations::block(Eigen::Index row) const {
  constexpr double kBlock = 0.5;  // s
  return std::lround(std::floor(windows_[static_cast<std::size_t>(row)].begin / kBlock));
}

Eigen::VectorXd AxisEquations::forces(double delay) const {
  Eigen::VectorXd f(matrix_.rows());
  for (Eigen::Index i = 0; i < f.size(); ++i)
    f[i] = weights_[i] * TestFunction(windows_[static_cast<std::size_t>(i)])
                             .integral_of_command(record_, record_.axis, delay);
  return f;
}

EquationFit AxisEquations::solve(double delay) const {
  EquationFit fit;
  const Eigen::VectorXd f = forces(delay);
  fit.solution = decomposition_.solve(f);
  fit.residual = f - matrix_ * fit.solution;
  fit.misfit = fit.residual.squaredNorm();
  return fit;
}

double AxisEquations::impulse_misfit(const Window& window, const EquationFit& fit,
                                     double delay) const {
  return TestFunction(window).integral_of_command(record_, record_.axis, delay) -
         row(window).dot(fit.solution);
}

double AxisEquations::impulse_deviation(const Window& window, const EquationFit& fit) const {
  const auto spare = static_cast<double>(matrix_.rows() - matrix_.cols());
  return std::sqrt(fit.misfit / std::max(1.0, spare)) / weight_of(window);
}

}  // namespace palpate::identify
