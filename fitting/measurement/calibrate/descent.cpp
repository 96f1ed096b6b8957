// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/descent.hpp"

#include <ceres/ceres.h>

#include <cmath>

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

}  // namespace

std::optional<Minimum> descend(const LeastSquares& problem) {
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
    options.gradient_tolerance = 1e-14;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &solver, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    if (!problem.model(p, found.residuals.data(), nullptr)) return std::nullopt;
    found.converged = summary.termination_type == ceres::CONVERGENCE;
    found.iterations = static_cast<int>(summary.iterations.size()) - 1;
  }
  for (const double value : found.residuals) found.cost += 0.5 * value * value;
  return found;
}

}  // namespace palpate::calibrate
