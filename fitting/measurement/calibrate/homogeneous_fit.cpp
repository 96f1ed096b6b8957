// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/homogeneous_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/measurement/calibrate/homogeneous_problem.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::calibrate {
namespace {

TestError error_of(const HomogeneousTest& test, const std::vector<double>& predicted) {
  TestError error;
  error.name = test.name;
  double squares = 0, mean = 0, total = 0;
  for (const double value : test.nominal) mean += value / static_cast<double>(test.nominal.size());
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const double e = predicted[i] - test.nominal[i];
    squares += e * e;
    total += (test.nominal[i] - mean) * (test.nominal[i] - mean);
    if (std::abs(e) < std::abs(error.worst)) continue;
    error.worst = e;
    error.worst_at = test.deformation[i];
  }
  error.rms = std::sqrt(squares / static_cast<double>(predicted.size()));
  error.relative = error.rms / rms(test.nominal);
  error.r2 = 1 - squares / total;
  return error;
}

double largest_strain(const std::vector<HomogeneousTest>& tests) {
  double largest = 0;
  for (const HomogeneousTest& test : tests) {
    for (const double s : test.deformation) {
      for (const double e : logarithmic_strains(test.mode, s)) {
        largest = std::max(largest, std::abs(e));
      }
    }
  }
  return largest;
}

/// A law that converges on data of another shape has constants, and they say little.
void warn_of_misfit(const std::vector<HomogeneousTest>& tests, HomogeneousFit& fit) {
  constexpr double kMissed = 0.25;  // of the root mean square of the stresses
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (!(fit.errors[i].relative > kMissed)) continue;
    fit.calibration.warnings.push_back(
        "the fitted law misses " + tests[i].name + " by " + percent_text(fit.errors[i].relative) +
        " of its root mean square stress: choose another law, or check columns and units");
  }
}

/// Strains in percent that are taken as ratios give stretches that nothing soft survives.
void warn_of_units(const std::vector<HomogeneousTest>& tests, HomogeneousFit& fit) {
  constexpr double kMostStretch = 15, kSoftest = 1, kStiffest = 100e6;
  for (const HomogeneousTest& test : tests) {
    const double most = *std::max_element(test.deformation.begin(), test.deformation.end());
    if (most > kMostStretch)
      fit.calibration.warnings.push_back("test '" + test.name + "' goes to a deformation of " +
                                         number_text(most) + ": check the unit of its strain");
  }
  if (fit.shear_modulus < kSoftest || fit.shear_modulus > kStiffest)
    fit.calibration.warnings.push_back(
        "a shear modulus of " + number_text(fit.shear_modulus) +
        " Pa is far from that of any soft tissue: check the units of force, "
        "area and stress");
}

void warn_of_instability(const std::vector<HomogeneousTest>& tests, HomogeneousFit& fit) {
  bool in_a_test = false;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const double at = fit.stability[i].unstable_at;
    if (!std::isfinite(at)) continue;
    in_a_test = true;
    fit.calibration.warnings.push_back("the fitted law is unstable in the range of " +
                                       tests[i].name + ": from a deformation of " +
                                       std::to_string(at) + " on");
  }
  const std::array<double, 3>& l = fit.all_states.unstable_at;
  if (in_a_test || !std::isfinite(l[0])) return;
  fit.calibration.warnings.push_back(
      "the fitted law is unstable outside the modes of the tests: at stretches " +
      std::to_string(l[0]) + ", " + std::to_string(l[1]) + ", " + std::to_string(l[2]) +
      ", within their strains; add a test in another mode, or bound the constants");
}

/// Stability of the law over the range of a test, from rest on.
StabilityLimit stability_of(const IncompressibleLaw& law, const std::vector<double>& c,
                            const HomogeneousTest& test) {
  const auto [low, high] = std::minmax_element(test.deformation.begin(), test.deformation.end());
  const double rest = rest_of(test.mode);
  return stability_in(law, c, {test.mode, std::min(*low, rest), std::max(*high, rest)});
}

std::vector<double> law_values(const IncompressibleLaw& law, const Calibration& calibration) {
  std::vector<double> c;
  for (std::size_t i = 0; i < law.constants().size(); ++i)
    c.push_back(calibration.estimates[i].value);
  return c;
}

/// A fit with the problem that it solves.
struct Solution {
  HomogeneousProblem problem;
  Calibration calibration;
};

/// Whether a constant is at a bound that the table does not have.
bool is_held(const Solution& fit, const HomogeneousProblem& wide) {
  for (std::size_t i = 0; i < wide.squares.constants.size(); ++i) {
    const Constant &own = fit.problem.squares.constants[i], &other = wide.squares.constants[i];
    if (fit.calibration.estimates[i].at_bound && (other.low < own.low || other.high > own.high))
      return true;
  }
  return false;
}

/// Where the law is refused by a case, or is unstable in the range of a test; empty: nowhere.
std::string fault_of(const IncompressibleLaw& law, const std::vector<double>& c,
                     const std::vector<HomogeneousTest>& tests) {
  try {
    fem::check_law(law.for_case(c), "the law");
  } catch (const Error& error) {
    return error.problem();
  }
  for (const HomogeneousTest& test : tests) {
    const double at = stability_of(law, c, test).unstable_at;
    if (std::isfinite(at))
      return "the law is unstable in the range of " + test.name + ": from a deformation of " +
             number_text(at) + " on";
  }
  return {};
}

/// Exchange terms of Ogden's law as long as that makes the fit better.
void exchange_terms(const HomogeneousProblem& problem, const IncompressibleLaw& law, bool any_sign,
                    const std::string& where, Calibration& fit) {
  constexpr int kMost = 3;
  constexpr double kBetter = 0.9999;
  for (int i = 0; i < kMost && problem.squares.canonical; ++i) {
    auto starts = exchanged_terms(law, problem.samples, law_values(law, fit),
                                  {.any_sign = any_sign, .offset = problem.offset});
    for (std::vector<double>& start : starts) start.resize(problem.squares.constants.size(), 0);
    const auto found = converged_minimum(problem.squares, starts, where);
    if (!found || !(found->cost < kBetter * fit.cost)) return;
    fit = *found;
  }
}

/// The best fit within the bounds that make the law stable everywhere; where one of them holds it,
/// that within the bounds of the table, if it is stable in the range of every test.
Solution best_fit(const std::vector<HomogeneousTest>& tests, const HomogeneousSettings& settings,
                  const IncompressibleLaw& law) {
  constexpr double kBetter = 0.98;  // of the cost, or it does not matter
  const std::string where = "fit of " + settings.law;
  Solution fit{problem_of(tests, settings, law, false), {}};
  const auto starts = fit.problem.starts(law, settings, false);
  fit.calibration = minimise(fit.problem.squares, starts, where);
  exchange_terms(fit.problem, law, false, where, fit.calibration);
  HomogeneousProblem wide = problem_of(tests, settings, law, true);
  if (!is_held(fit, wide)) return fit;
  const auto found = converged_minimum(wide.squares, wide.starts(law, settings, true), where);
  if (!found || !(found->cost < kBetter * fit.calibration.cost)) return fit;
  const std::string fault = fault_of(law, law_values(law, *found), tests);
  if (fault.empty()) return {std::move(wide), *found};
  fit.calibration.warnings.push_back("constants beyond the bounds fit better (residuals " +
                                     number_text(std::sqrt(found->cost / fit.calibration.cost)) +
                                     " times as large) and are not taken: with them " + fault);
  return fit;
}

/// @throws Error(Configuration) where no stress at all would fit as well.
void check_fit(const HomogeneousProblem& problem, const Calibration& calibration,
               const std::string& where) {
  double squares = 0;
  for (const WeightedSample& s : problem.samples) squares += std::pow(s.stress * s.factor, 2);
  if (2 * calibration.cost < squares) return;
  refuse(where, "the law fits the data no better than no stress at all",
         "check signs, units and modes of the tests, or widen the bounds of the constants");
}

/// What the fitted constants make of the tests.
void add_predictions(const std::vector<HomogeneousTest>& tests, const IncompressibleLaw& law,
                     const std::vector<double>& c, HomogeneousFit& fit) {
  std::size_t next = law.constants().size();
  for (const HomogeneousTest& test : tests) {
    std::vector<double>& predicted = fit.predicted.emplace_back();
    const double offset = test.offset ? fit.calibration.estimates[next++].value : 0;
    for (std::size_t i = 0; i < test.deformation.size(); ++i)
      predicted.push_back(law.stress(c.data(), test.mode, test.deformation[i]) *
                              (test.effect.empty() ? 1 : test.effect[i]) +
                          offset);
    fit.errors.push_back(error_of(test, predicted));
    fit.stability.push_back(stability_of(law, c, test));
  }
  fit.all_states = stability_of_states(law, c, largest_strain(tests));
  warn_of_misfit(tests, fit);
  warn_of_instability(tests, fit);
  warn_of_units(tests, fit);
}

}  // namespace

HomogeneousFit fit_homogeneous(const std::vector<HomogeneousTest>& tests,
                               const HomogeneousSettings& settings) {
  const IncompressibleLaw law(settings.law, settings.poisson);
  const Solution solution = best_fit(tests, settings, law);
  HomogeneousFit fit;
  fit.calibration = solution.calibration;
  check_fit(solution.problem, fit.calibration, "fit of " + settings.law);
  if (settings.profiles)
    add_profiles(solution.problem.squares, fit.calibration, {.of = {}, .between = 4});
  const std::vector<double> c = law_values(law, fit.calibration);
  fit.law = law.for_case(c);
  fem::check_law(fit.law, "fit of " + settings.law);
  fit.shear_modulus = fem::rest_moduli(fit.law).mu();
  add_predictions(tests, law, c, fit);
  return fit;
}

}  // namespace palpate::calibrate
