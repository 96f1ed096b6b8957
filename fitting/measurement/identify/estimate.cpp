// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/estimate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "fitting/measurement/identify/axis_equations.hpp"
#include "fitting/measurement/identify/delay_spread.hpp"
#include "fitting/measurement/identify/weak_form.hpp"

namespace palpate::identify {
namespace {

constexpr std::size_t kFewest = 60;         // equations
constexpr double kSlowSpeed = 0.02;         // of the largest speed: slow
constexpr int kDelaySteps = 60;             // of the search over delays
constexpr double kTooUncertain = 0.25;      // deviation of the mass over the mass
constexpr double kLeastTravelInSteps = 50;  // of the position

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
Eigen::VectorXd deviations(const AxisEquations& equations, const EquationFit& fit, double delay) {
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
double residual_force(const AxisEquations& equations, const EquationFit& fit) {
  const Eigen::VectorXd scale = equations.matrix().rightCols(1);  // weighted integral of phi
  return std::sqrt(fit.residual.cwiseQuotient(scale).squaredNorm() /
                   static_cast<double>(fit.residual.size()));
}

void enter(const AxisEquations& equations, const EquationFit& fit, double delay,
           AxisEstimate& estimate) {
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

double position_step(const MotionRecord& record) {
  const std::vector<double> velocity = smooth_velocity(record, record.axis);
  double largest = 0;
  for (const double v : velocity) largest = std::max(largest, std::abs(v));
  double step = 0;
  for (std::size_t i = 0; i + 1 < record.sine_rows(); ++i) {
    if (std::abs(velocity[i]) > 2 * kSlowSpeed * largest) continue;
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
  const EquationFit fit = equations.solve(delay);
  enter(equations, fit, delay, estimate);
  estimate.spread = delay_spread(record, equations, fit, delay);
  if (!(estimate.mass.deviation < kTooUncertain * estimate.mass.value))
    estimate.problem = "the motion does not follow the force; free the handle";
  else if (delay > 0.98 * largest_delay)
    estimate.problem = "the force comes later than can be measured; check the connection";
  return estimate;
}

}  // namespace palpate::identify
