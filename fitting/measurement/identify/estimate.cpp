// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/estimate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "fitting/measurement/identify/weak_form.hpp"

namespace palpate::identify {
namespace {

constexpr std::size_t kFewest = 60;         // equations
constexpr double kStill = 0.02;             // of the motion of the excited axis: no motion
constexpr int kDelaySteps = 60;             // of the search over delays
constexpr double kTooUncertain = 0.25;      // deviation of the mass over the mass
constexpr double kLeastTravelInSteps = 50;  // of the position

/// Largest distance between two positions along an axis, m.
double travel_of(const MotionRecord& record, std::size_t axis) {
  double low = kInfinity, high = -kInfinity;
  for (const Vec3& x : record.position)
    low = std::min(low, x[axis]), high = std::max(high, x[axis]);
  return record.position.empty() ? 0 : high - low;
}

struct Fit {
  Eigen::VectorXd solution, residual;
  double misfit = 0;  ///< sum of squares
};

/// The linear equations of an axis; only the right side depends on the delay.
class AxisEquations {
 public:
  AxisEquations(const MotionRecord& record, double largest_delay)
      : record_(record), windows_(one_way_windows(record, largest_delay)) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (axis == record.axis || moves(axis)) axes_.push_back(axis);
    std::swap(axes_.front(), *std::find(axes_.begin(), axes_.end(), record.axis));
    fill();
  }

  std::size_t size() const { return windows_.size(); }
  /// Columns: accelerations of axes(), velocities of axes(), sign of the velocity, position, one.
  const Eigen::MatrixXd& matrix() const { return matrix_; }
  const std::vector<std::size_t>& axes() const { return axes_; }
  /// Number of the half second in which an equation begins.
  long block(Eigen::Index row) const {
    constexpr double kBlock = 0.5;  // s
    return std::lround(std::floor(windows_[static_cast<std::size_t>(row)].begin / kBlock));
  }

  Eigen::VectorXd forces(double delay) const {
    Eigen::VectorXd f(matrix_.rows());
    for (Eigen::Index i = 0; i < f.size(); ++i)
      f[i] = weights_[i] * TestFunction(windows_[static_cast<std::size_t>(i)])
                               .integral_of_command(record_, record_.axis, delay);
    return f;
  }

  Fit solve(double delay) const {
    Fit fit;
    const Eigen::VectorXd f = forces(delay);
    fit.solution = decomposition_.solve(f);
    fit.residual = f - matrix_ * fit.solution;
    fit.misfit = fit.residual.squaredNorm();
    return fit;
  }

 private:
  bool moves(std::size_t axis) const {
    return travel_of(record_, axis) > kStill * travel_of(record_, record_.axis);
  }

  void fill() {
    const auto n = static_cast<Eigen::Index>(axes_.size());
    const auto rows = static_cast<Eigen::Index>(windows_.size());
    matrix_.resize(rows, 2 * n + 3);
    weights_.resize(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Window& w = windows_[static_cast<std::size_t>(i)];
      const TestFunction phi(w);
      for (Eigen::Index j = 0; j < n; ++j) {
        const std::size_t axis = axes_[static_cast<std::size_t>(j)];
        matrix_(i, j) = phi.integral_of(record_, axis, 2);
        matrix_(i, n + j) = -phi.integral_of(record_, axis, 1);
      }
      matrix_(i, 2 * n) = w.direction * phi.integral();
      matrix_(i, 2 * n + 1) = phi.integral_of(record_, record_.axis, 0);
      matrix_(i, 2 * n + 2) = phi.integral();
      // Noise of the positions enters the integral of phi'' x like length^-1.5.
      weights_[i] = std::pow(w.end - w.begin, 1.5);
      matrix_.row(i) *= weights_[i];
    }
    if (rows > 0) decomposition_.compute(matrix_);
  }

  const MotionRecord& record_;
  std::vector<Window> windows_;
  std::vector<std::size_t> axes_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd weights_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition_;
};

/// The delay with the smallest misfit: the best of equal steps, then by golden section beside it.
double best_delay(const AxisEquations& equations, double largest) {
  const double step = largest / kDelaySteps;
  double best = 0, misfit = kInfinity;
  for (int i = 0; i <= kDelaySteps; ++i) {
    const double here = equations.solve(i * step).misfit;
    if (here < misfit) misfit = here, best = i * step;
  }
  double low = std::max(0.0, best - step), high = std::min(largest, best + step);
  const double golden = (std::sqrt(5.0) - 1) / 2;
  while (high - low > 1e-3 * step) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (equations.solve(a).misfit < equations.solve(b).misfit)
      high = b;
    else
      low = a;
  }
  return (low + high) / 2;
}

/// The Jacobian of the forces, the delay last; each column scaled to length 1, so that the rank is
/// not lost to units.
Eigen::MatrixXd jacobian_of(const AxisEquations& equations, double delay, Eigen::VectorXd& length) {
  constexpr double kStep = 1e-5;  // s
  const Eigen::MatrixXd& a = equations.matrix();
  Eigen::MatrixXd jacobian(a.rows(), a.cols() + 1);
  jacobian.leftCols(a.cols()) = a;
  jacobian.rightCols(1) =
      -(equations.forces(delay + kStep) - equations.forces(std::max(0.0, delay - kStep))) /
      (kStep + std::min(kStep, delay));
  length = jacobian.colwise().norm().cwiseMax(1e-300);
  return jacobian * length.cwiseInverse().asDiagonal();
}

/// Sum over blocks of time of g g^T with g = J^T r of the block: the covariance of J^T r where the
/// residuals of a block are correlated [White 1984, ch. VI; Liang & Zeger 1986].
Eigen::MatrixXd block_scatter(const Eigen::MatrixXd& jacobian, const AxisEquations& equations,
                              const Eigen::VectorXd& residual) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(jacobian.cols());
  double blocks = 0;
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
    gradient += residual[i] * jacobian.row(i).transpose();
    const bool last = i + 1 == jacobian.rows() || equations.block(i + 1) != equations.block(i);
    if (!last) continue;
    sum += gradient * gradient.transpose();
    gradient.setZero();
    ++blocks;
  }
  return sum * blocks / std::max(1.0, blocks - 1);
}

/// Standard deviations of the solution and, last, of the delay: the larger of those for independent
/// residuals and for residuals that are correlated within half a second.
Eigen::VectorXd deviations(const AxisEquations& equations, const Fit& fit, double delay) {
  Eigen::VectorXd length;
  const Eigen::MatrixXd j = jacobian_of(equations, delay, length);
  const Eigen::MatrixXd inverse =
      (j.transpose() * j).ldlt().solve(Eigen::MatrixXd::Identity(j.cols(), j.cols()));
  const double variance = fit.misfit / static_cast<double>(j.rows() - j.cols());
  const Eigen::VectorXd independent = variance * inverse.diagonal();
  const Eigen::VectorXd correlated =
      (inverse * block_scatter(j, equations, fit.residual) * inverse).diagonal();
  return independent.cwiseMax(correlated).cwiseMax(0).cwiseSqrt().cwiseQuotient(length);
}

/// Root mean square of the misfit as a force.
double residual_force(const AxisEquations& equations, const Fit& fit) {
  const Eigen::VectorXd scale = equations.matrix().rightCols(1);  // weighted integral of phi
  return std::sqrt(fit.residual.cwiseQuotient(scale).squaredNorm() /
                   static_cast<double>(fit.residual.size()));
}

void enter(const AxisEquations& equations, const Fit& fit, double delay, AxisEstimate& estimate) {
  const Eigen::VectorXd deviation = deviations(equations, fit, delay);
  const auto n = static_cast<Eigen::Index>(equations.axes().size());
  const auto at = [&](Eigen::Index i) { return Measured{fit.solution[i], deviation[i]}; };
  estimate.mass = at(0);
  for (Eigen::Index j = 0; j < n; ++j)
    estimate.damping[equations.axes()[static_cast<std::size_t>(j)]] = at(n + j);
  estimate.friction = at(2 * n);
  estimate.stiffness = at(2 * n + 1);
  estimate.bias = at(2 * n + 2);
  estimate.delay = {delay, deviation[2 * n + 3]};
  estimate.residual = residual_force(equations, fit);
}

}  // namespace

Measured smallest_damping(const std::vector<std::size_t>& axes,
                          const std::vector<AxisEstimate>& estimates) {
  const auto n = static_cast<Eigen::Index>(axes.size());
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, n);
  double squares = 0;
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (std::size_t j = 0; j < axes.size(); ++j) {
      const Measured& entry = estimates[i].damping[axes[j]];
      if (std::isnan(entry.value)) continue;
      b(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = entry.value;
      squares += entry.deviation * entry.deviation;
    }
  const Eigen::MatrixXd symmetric = (b + b.transpose()) / 2;
  return {Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues()[0],
          std::sqrt(squares)};
}

double position_step(const MotionRecord& record) {
  const std::vector<double> velocity = smooth_velocity(record, record.axis);
  double largest = 0;
  for (const double v : velocity) largest = std::max(largest, std::abs(v));
  double step = 0;
  for (std::size_t i = 0; i + 1 < velocity.size(); ++i) {
    if (std::abs(velocity[i]) > 2 * kStill * largest) continue;
    const double moved = record.position[i + 1][record.axis] - record.position[i][record.axis];
    const double smooth =
        (velocity[i] + velocity[i + 1]) / 2 * (record.time[i + 1] - record.time[i]);
    step = std::max(step, std::abs(moved - smooth));
  }
  return step;
}

AxisEstimate estimate_axis(const MotionRecord& record, double largest_delay) {
  AxisEstimate estimate;
  estimate.travel = travel_of(record, record.axis);
  if (!(estimate.travel > kLeastTravelInSteps * position_step(record))) {
    estimate.problem = "it moves too little to be measured; raise --max-force or free the handle";
    return estimate;
  }
  const AxisEquations equations(record, largest_delay);
  estimate.windows = equations.size();
  if (equations.size() < kFewest) {
    estimate.problem = "there are too few swings; raise --seconds or --max-force";
    return estimate;
  }
  const double delay = best_delay(equations, largest_delay);
  enter(equations, equations.solve(delay), delay, estimate);
  if (!(estimate.mass.deviation < kTooUncertain * estimate.mass.value))
    estimate.problem = "the motion does not follow the force; free the handle";
  else if (delay > 0.98 * largest_delay)
    estimate.problem = "the force comes later than can be measured; check the connection";
  return estimate;
}

}  // namespace palpate::identify
