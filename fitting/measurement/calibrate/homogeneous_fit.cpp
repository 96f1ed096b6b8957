// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/homogeneous_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "format/error.hpp"

namespace palpate::calibrate {
namespace {

constexpr double kLeastRelative = 0.05;  ///< of the largest stress, under Weighting::Relative

void check_tests(const std::vector<HomogeneousTest>& tests, const HomogeneousSettings& settings) {
  if (tests.empty()) refuse("calibration", "there are no tests", "give at least one");
  for (const HomogeneousTest& test : tests) {
    if (test.deformation.empty() || test.deformation.size() != test.nominal.size()) {
      refuse(test.name, "deformations and stresses are not equally many", "give pairs");
    }
    if (settings.weighting == Weighting::Uncertainty &&
        test.uncertainty.size() != test.nominal.size()) {
      refuse(test.name, "it states no uncertainty",
             "give a column with it, or choose another weighting");
    }
    for (const double s : test.deformation) {
      if (test.mode == Mode::SimpleShear || s > 0) continue;
      refuse(test.name, "a stretch of " + std::to_string(s) + " is not positive",
             "give stretches, not strains (1 at rest)");
    }
  }
}

double rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

/// Deviations of the noise of each residual of a test under the factors below: what a test counts,
/// by its weight and by the number of its samples, says nothing of its noise. `mean` is the mean
/// number of samples of the tests.
double deviation_of(const HomogeneousTest& test, Weighting weighting, double mean) {
  const double samples =
      weighting == Weighting::PerTest ? mean / static_cast<double>(test.nominal.size()) : 1;
  return test.weight * std::sqrt(samples);
}

/// What each residual of a test, in nominal stress, is multiplied by before its deviation.
std::vector<double> factors(const HomogeneousTest& test, const HomogeneousSettings& settings) {
  std::vector<double> ratio, measured;
  double largest = 0;
  for (std::size_t i = 0; i < test.nominal.size(); ++i) {
    ratio.push_back(settings.residual == Residual::Cauchy
                        ? cauchy_over_nominal(test.mode, test.deformation[i])
                        : 1);
    measured.push_back(test.nominal[i] * ratio[i]);
    largest = std::max(largest, std::abs(measured[i]));
  }
  const auto scale = [&](std::size_t i) {
    switch (settings.weighting) {
      case Weighting::Absolute:
        break;
      case Weighting::PerTest:
        return std::max(rms(measured), 1e-300);
      case Weighting::Relative:
        return std::max({std::abs(measured[i]), kLeastRelative * largest, 1e-300});
      case Weighting::Uncertainty:
        return test.uncertainty[i] * ratio[i];
    }
    return 1.0;
  };
  std::vector<double> out;
  for (std::size_t i = 0; i < measured.size(); ++i) out.push_back(ratio[i] / scale(i));
  return out;
}

/// A first guess of the shear modulus: the stress over the strain measure of a neo-Hookean solid.
double modulus_scale(const std::vector<HomogeneousTest>& tests) {
  double above = 0, below = 0;
  const IncompressibleLaw unit("neo-hookean", 0.5);
  const double young = 3;  // of a shear modulus of one
  for (const HomogeneousTest& test : tests) {
    for (std::size_t i = 0; i < test.nominal.size(); ++i) {
      const double g = unit.stress(&young, test.mode, test.deformation[i]);
      above += g * test.nominal[i];
      below += g * g;
    }
  }
  return below > 0 && above > 0 ? above / below : 1;
}

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

std::string names_of(const std::vector<Constant>& constants) {
  std::string names;
  for (const Constant& constant : constants) names += (names.empty() ? "" : ", ") + constant.name;
  return names;
}

std::vector<Constant> problem_constants(const IncompressibleLaw& law, double scale,
                                        const HomogeneousSettings& settings) {
  std::vector<Constant> out;
  for (const ConstantInfo& info : default_constants(law, scale)) {
    ConstantInfo used = info;
    for (const ConstantInfo& given : settings.constants) {
      if (given.name == info.name) used = given;
    }
    out.push_back({used.name, info.is_stress ? "Pa" : "1", used.start, used.low, used.high});
  }
  for (const ConstantInfo& given : settings.constants) {
    const auto is_it = [&](const Constant& c) { return c.name == given.name; };
    if (std::any_of(out.begin(), out.end(), is_it)) continue;
    refuse("constant '" + given.name + "'", "the law " + std::string(law.name()) + " has no such",
           "its constants are " + names_of(out));
  }
  return out;
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

/// Residuals of all tests, and their derivatives by the constants.
LeastSquares problem_of(const std::vector<HomogeneousTest>& tests,
                        const HomogeneousSettings& settings, const IncompressibleLaw& law,
                        double scale) {
  LeastSquares problem;
  problem.constants = problem_constants(law, scale, settings);
  problem.confidence = settings.confidence;
  problem.known_scatter = settings.weighting == Weighting::Uncertainty;
  std::vector<std::vector<double>> factor;
  for (const HomogeneousTest& test : tests) {
    problem.residuals += test.nominal.size();
    problem.series.push_back(test.nominal.size());
  }
  const double mean = static_cast<double>(problem.residuals) / static_cast<double>(tests.size());
  for (const HomogeneousTest& test : tests) {
    const double deviation = deviation_of(test, settings.weighting, mean);
    problem.deviations.insert(problem.deviations.end(), test.nominal.size(), deviation);
    for (double& f : factor.emplace_back(factors(test, settings))) f *= deviation;
  }
  const std::size_t n = problem.constants.size();
  problem.model = [&tests, law, factor, n](const double* c, double* r, double* J) {
    std::vector<double> slope(n);
    std::size_t row = 0;
    for (std::size_t t = 0; t < tests.size(); ++t) {
      for (std::size_t i = 0; i < tests[t].nominal.size(); ++i, ++row) {
        const double P = law.stress(c, tests[t].mode, tests[t].deformation[i],
                                    J == nullptr ? nullptr : slope.data());
        r[row] = (P - tests[t].nominal[i]) * factor[t][i];
        if (!std::isfinite(r[row])) return false;
        if (J == nullptr) continue;
        for (std::size_t k = 0; k < n; ++k) J[row * n + k] = slope[k] * factor[t][i];
      }
    }
    return true;
  };
  return problem;
}

/// What the fitted constants make of the tests.
void add_predictions(const std::vector<HomogeneousTest>& tests, const IncompressibleLaw& law,
                     const std::vector<double>& c, HomogeneousFit& fit) {
  for (const HomogeneousTest& test : tests) {
    std::vector<double>& predicted = fit.predicted.emplace_back();
    for (const double s : test.deformation) {
      predicted.push_back(law.stress(c.data(), test.mode, s));
    }
    fit.errors.push_back(error_of(test, predicted));
    const auto [low, high] = std::minmax_element(test.deformation.begin(), test.deformation.end());
    const double rest = rest_of(test.mode);
    fit.stability.push_back(
        stability_in(law, c, {test.mode, std::min(*low, rest), std::max(*high, rest)}));
  }
  fit.all_states = stability_of_states(law, c, largest_strain(tests));
  warn_of_instability(tests, fit);
}

}  // namespace

HomogeneousFit fit_homogeneous(const std::vector<HomogeneousTest>& tests,
                               const HomogeneousSettings& settings) {
  const IncompressibleLaw law(settings.law, settings.poisson);
  check_tests(tests, settings);
  const double scale = modulus_scale(tests);
  const LeastSquares problem = problem_of(tests, settings, law, scale);
  HomogeneousFit fit;
  const std::string where = "fit of " + settings.law;
  std::vector<std::vector<double>> starts;
  if (settings.constants.empty()) starts = several_starts(law, scale);
  fit.calibration = starts.empty() ? minimise(problem, where) : minimise(problem, starts, where);
  if (settings.profiles) add_profiles(problem, fit.calibration);
  std::vector<double> c;
  for (const Estimate& e : fit.calibration.estimates) c.push_back(e.value);
  fit.law = law.for_case(c);
  fit.shear_modulus = fem::rest_moduli(fit.law).mu();
  add_predictions(tests, law, c, fit);
  return fit;
}

}  // namespace palpate::calibrate
