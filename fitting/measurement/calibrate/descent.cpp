// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/descent.hpp"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "fitting/measurement/calibrate/projection.hpp"

namespace palpate::calibrate {
namespace {

class Cost : public ceres::CostFunction {
 public:
  explicit Cost(const LeastSquares& problem) : problem_(problem) {
    set_num_residuals(static_cast<int>(problem.residuals));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.constants.size()));
  }
  bool Evaluate(const double* const* constants, double* r, double** J) const override {
    return problem_.model(constants[0], r, J != nullptr ? J[0] : nullptr);
  }

 private:
  const LeastSquares& problem_;
};

/// Ceres logs each failed step of a search to the standard error, hundreds of lines of a fit that
/// converges all the same. What became of the fit is in its summary.
void silence_steps() {
  FLAGS_minloglevel = google::GLOG_FATAL;
}

/// Whether no constant that may move would lower the cost: the residuals are normal to every column
/// of the Jacobian, or nothing beside what the constants contribute to the model.
bool is_stationary(const LeastSquares& problem, const std::vector<double>& at,
                   const std::vector<double>& r) {
  constexpr double kNormal = 1e-6, kNothing = 1e-9;
  const std::size_t n = at.size();
  std::vector<double> J(r.size() * n), unused(r.size());
  if (!problem.model(at.data(), unused.data(), J.data())) return false;
  double squares = 0, largest = 0, steepest = 0;
  for (const double value : r) squares += value * value;
  for (std::size_t k = 0; k < n; ++k) {
    double slope = 0, length = 0;
    for (std::size_t row = 0; row < r.size(); ++row) {
      slope += J[row * n + k] * r[row];
      length += J[row * n + k] * J[row * n + k];
    }
    largest = std::max(largest, length * at[k] * at[k]);
    const Constant& c = problem.constants[k];
    const bool stopped = (at[k] <= c.low && slope > 0) || (at[k] >= c.high && slope < 0);
    if (!stopped && length > 0) steepest = std::max(steepest, slope * slope / length);
  }
  return steepest <= kNormal * kNormal * squares || squares <= kNothing * kNothing * largest;
}

std::optional<Minimum> descend_at_once(const LeastSquares& problem) {
  const std::size_t n = problem.constants.size();
  Minimum found;
  found.at.resize(n);
  found.residuals.resize(problem.residuals);
  for (std::size_t i = 0; i < n; ++i) found.at[i] = problem.constants[i].start;
  double* p = found.at.data();
  if (!problem.model(p, found.residuals.data(), nullptr)) return std::nullopt;
  if (n > 0) {
    ceres::Problem solver;
    solver.AddResidualBlock(new Cost(problem), nullptr, p);
    for (std::size_t i = 0; i < n; ++i) {
      const Constant& c = problem.constants[i];
      if (std::isfinite(c.low)) solver.SetParameterLowerBound(p, static_cast<int>(i), c.low);
      if (std::isfinite(c.high)) solver.SetParameterUpperBound(p, static_cast<int>(i), c.high);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = problem.max_iterations;
    options.function_tolerance = problem.tolerance;
    options.parameter_tolerance = problem.step_tolerance;
    options.gradient_tolerance = 0;  // it is not relative
    options.logging_type = ceres::SILENT;
    silence_steps();
    ceres::Solver::Summary summary;
    ceres::Solve(options, &solver, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    if (!problem.model(p, found.residuals.data(), nullptr)) return std::nullopt;
    found.converged = summary.termination_type == ceres::CONVERGENCE ||
                      is_stationary(problem, found.at, found.residuals);
    found.iterations = static_cast<int>(summary.iterations.size()) - 1;
  }
  for (const double value : found.residuals) found.cost += 0.5 * value * value;
  return found;
}

/// Along the valley in the constants that bend the residuals, and from its end in all of them.
std::optional<Minimum> descend_along_valley(LeastSquares problem, const std::vector<double>& from) {
  for (std::size_t k = 0; k < from.size(); ++k) problem.constants[k].start = from[k];
  const Projection projection(problem);
  if (!projection.is_useful()) return std::nullopt;
  const auto end = descend_at_once(projection.reduced());
  std::vector<double> all;
  if (!end || !projection.expand(end->at.data(), all)) return std::nullopt;
  for (std::size_t k = 0; k < all.size(); ++k) problem.constants[k].start = all[k];
  return descend_at_once(problem);
}

}  // namespace

std::optional<Minimum> descend(const LeastSquares& problem) {
  auto found = descend_at_once(problem);
  if (!found || found->converged) return found;
  auto farther = descend_along_valley(problem, found->at);
  if (!farther || !(farther->cost <= found->cost)) return found;
  farther->iterations += found->iterations;
  return farther;
}

}  // namespace palpate::calibrate
