// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "fitting/measurement/calibrate/descent.hpp"
#include "fitting/measurement/calibrate/intervals.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

constexpr double kStrongCorrelation = 0.95;
/// Costs closer than this, relatively, are the same.
constexpr double kSameCost = 1e-6;
/// Distance to a bound, relative to its size, that counts as being there.
constexpr double kAtBound = 1e-8;

bool is_at(double value, double bound) {
  return std::isfinite(bound) &&
         std::abs(value - bound) <= kAtBound * std::max(1e-12, std::abs(bound));
}

void add_warnings(const LeastSquares& problem, Calibration& result) {
  const auto warn = [&](const std::string& text) { result.warnings.push_back(text); };
  for (std::size_t i = 0; i < result.estimates.size(); ++i) {
    const Estimate& e = result.estimates[i];
    if (e.at_bound) {
      warn(e.name + " is at its bound " + number_text(e.value) +
           ": the interval says nothing there; widen the bound or choose another law");
      continue;
    }
    if (!problem.constants[i].may_vanish && !(0.5 * (e.high - e.low) < std::abs(e.value))) {
      warn(e.name + " is not determined: its interval is wider than its value");
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double c = result.correlation[i][j];
      if (!(std::abs(c) > kStrongCorrelation)) continue;
      warn(result.estimates[j].name + " and " + e.name + " are correlated by " + number_text(c) +
           ": the data hardly distinguish them");
    }
  }
  if (result.widened) {
    warn("the residuals are " + number_text(result.scatter) +
         " times the stated uncertainty: the model does not describe the data within it; the "
         "intervals are widened by that factor, as if the misfit were noise");
  }
  if (result.correlated) {
    warn("the residuals of neighbouring points are alike (correlation " +
         number_text(result.lag_one) + " after the fit, " +
         (result.beyond_noise ? "more than in any noise, and not known"
                              : number_text(result.autocorrelation)) +
         " before it, Durbin-Watson " + number_text(result.durbin_watson) +
         "): the model misses the shape of the data; the intervals are up to " +
         number_text(result.correlation_widening) +
         " times as wide for it, as if the misfit were correlated noise");
  }
}

void check_problem(const LeastSquares& problem, const std::string& where) {
  if (problem.residuals < problem.constants.size()) {
    refuse(where,
           std::to_string(problem.residuals) + " values cannot determine " +
               std::to_string(problem.constants.size()) + " constants",
           "give more data or a law with fewer constants");
  }
  for (const Constant& c : problem.constants) {
    if (c.start >= c.low && c.start <= c.high) continue;
    refuse(where,
           "the start " + number_text(c.start) + " of " + c.name + " is not within " +
               number_text(c.low) + " .. " + number_text(c.high),
           "choose a start within the bounds");
  }
}

std::optional<Calibration> try_minimise(const LeastSquares& problem) {
  const std::size_t n = problem.constants.size();
  auto found = descend(problem);
  if (!found) return std::nullopt;
  std::vector<double>&r = found->residuals, &J = found->J;
  if (problem.canonical) {
    problem.canonical(found->at);
    if (!problem.model(found->at.data(), r.data(), J.data())) return std::nullopt;
  }
  Calibration result;
  result.converged = found->converged;
  result.iterations = found->iterations;
  result.cost = found->cost;
  for (std::size_t i = 0; i < n; ++i) {
    const Constant& c = problem.constants[i];
    const double value = found->at[i];
    Estimate& e = result.estimates.emplace_back();
    e.name = c.name;
    e.unit = c.unit;
    e.logarithm = c.logarithm;
    e.value = value;
    e.standard_error = e.low = e.high = kUnknown;
    e.at_bound = is_at(value, c.low) || is_at(value, c.high);
  }
  add_intervals(problem, J, r, result);
  add_warnings(problem, result);
  return result;
}

/// Two sets of constants that fit alike but are not alike.
void warn_of_other_minimum(const std::vector<Calibration>& found, Calibration& best) {
  for (const Calibration& other : found) {
    if (!other.converged || other.cost > best.cost * (1 + kSameCost)) continue;
    bool apart = false;
    std::string text;
    for (std::size_t i = 0; i < other.estimates.size(); ++i) {
      const double a = best.estimates[i].value, b = other.estimates[i].value;
      apart = apart || std::abs(a - b) > 0.01 * (std::abs(a) + std::abs(b));
      text += (text.empty() ? "" : ", ") + other.estimates[i].name + " = " + number_text(b);
    }
    if (!apart) continue;
    best.warnings.push_back("another set of constants fits as well: " + text);
    return;
  }
}

/// The best ends of descents from several starts: of those that converged, and of the others.
struct Ends {
  std::optional<Calibration> best, unfinished;
};

Ends ends_of(LeastSquares problem, const std::vector<std::vector<double>>& starts,
             const std::string& where) {
  check_problem(problem, where);
  Ends ends;
  std::vector<Calibration> found;
  for (const std::vector<double>& start : starts) {
    for (std::size_t i = 0; i < start.size(); ++i) {
      Constant& c = problem.constants[i];
      c.start = std::clamp(start[i], c.low, c.high);
    }
    const auto result = try_minimise(problem);
    if (!result) continue;
    auto& known = result->converged ? ends.best : ends.unfinished;
    if (result->converged) found.push_back(*result);
    if (!known || result->cost < known->cost * (1 - kSameCost)) known = result;
  }
  if (ends.best) warn_of_other_minimum(found, *ends.best);
  return ends;
}

[[noreturn]] void refuse_divergence(const std::string& where, const Calibration& reached,
                                    std::size_t starts) {
  std::string values;
  for (const Estimate& e : reached.estimates)
    values += (values.empty() ? "" : ", ") + e.name + " = " + number_text(e.value);
  const std::string who = starts == 1 ? "the iteration does not converge"
                                      : "none of " + std::to_string(starts) + " starts converges";
  refuse(
      where,
      who + "; after " + std::to_string(reached.iterations) + " iterations at " + values +
          " the misfit still falls",
      "choose a law with fewer constants, bound the constants, or add data that tell them apart");
}

}  // namespace

Calibration minimise(const LeastSquares& problem, const std::string& where) {
  check_problem(problem, where);
  const auto result = try_minimise(problem);
  if (!result) refuse(where, "the model has no value near the start", "choose another start");
  if (!result->converged) refuse_divergence(where, *result, 1);
  return *result;
}

Calibration minimise(LeastSquares problem, const std::vector<std::vector<double>>& starts,
                     const std::string& where) {
  const Ends ends = ends_of(std::move(problem), starts, where);
  if (ends.best) return *ends.best;
  if (ends.unfinished) refuse_divergence(where, *ends.unfinished, starts.size());
  refuse(where, "the model has no value near any start", "give starts of the constants");
}

std::optional<Calibration> converged_minimum(LeastSquares problem,
                                             const std::vector<std::vector<double>>& starts,
                                             const std::string& where) {
  return ends_of(std::move(problem), starts, where).best;
}

}  // namespace palpate::calibrate
