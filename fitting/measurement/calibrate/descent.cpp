// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/descent.hpp"

#include <algorithm>
#include <utility>

#include "fitting/measurement/calibrate/levenberg_marquardt.hpp"
#include "fitting/measurement/calibrate/projection.hpp"

namespace palpate::calibrate {
namespace {

/// Whether no constant that may move would lower the cost: the residuals are normal to every column
/// of the Jacobian, or nothing beside what the constants contribute to the model.
bool is_stationary(const LeastSquares& problem, const Minimum& found) {
  constexpr double kNormal = 1e-6, kNothing = 1e-9;
  const std::vector<double>&at = found.at, &r = found.residuals, &J = found.J;
  const std::size_t n = at.size();
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
  auto found = levenberg_marquardt(problem);
  if (found) found->converged = found->converged || is_stationary(problem, *found);
  return found;
}

/// Along the valley in the constants that bend the residuals, and from its end in all of them.
std::optional<Minimum> descend_along_valley(LeastSquares problem) {
  const Projection projection(problem);
  if (!projection.is_useful()) return std::nullopt;
  const auto end = descend_at_once(projection.reduced());
  std::vector<double> all;
  if (!end || !projection.expand(end->at.data(), all)) return std::nullopt;
  for (std::size_t k = 0; k < all.size(); ++k) problem.constants[k].start = all[k];
  auto found = descend_at_once(problem);
  if (found) found->iterations += end->iterations;
  return found;
}

/// The same from where another descent has come.
std::optional<Minimum> descend_farther(LeastSquares problem, const Minimum& from) {
  for (std::size_t k = 0; k < from.at.size(); ++k) problem.constants[k].start = from.at[k];
  auto farther = descend_along_valley(std::move(problem));
  if (farther) farther->iterations += from.iterations;
  return farther;
}

}  // namespace

std::optional<Minimum> descend(const LeastSquares& problem) {
  if (problem.linear_first) {
    if (auto found = descend_along_valley(problem)) return found;
  }
  auto found = descend_at_once(problem);
  if (!found || found->converged) return found;
  auto farther = descend_farther(problem, *found);
  return farther && farther->cost <= found->cost ? farther : found;
}

}  // namespace palpate::calibrate
