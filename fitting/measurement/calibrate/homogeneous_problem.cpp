// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/homogeneous_problem.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

constexpr int kMostIterations = 500;
constexpr double kTolerance = 1e-15;     ///< of the cost: valleys of exponents are flat
constexpr double kLeastRelative = 0.05;  ///< of the largest stress, under Weighting::Relative
/// Poisson's ratio from which on a test with free faces passes for incompressible.
constexpr double kNearlyIncompressible = 0.45;

/// Confined compression has the volume changes of Poisson's ratio, and the other tests have none.
void check_confined(const std::vector<HomogeneousTest>& tests, double poisson) {
  const auto confined = std::count_if(tests.begin(), tests.end(),
                                      [](const auto& t) { return t.mode == Mode::Confined; });
  if (confined == 0 || confined == std::ssize(tests) || poisson >= kNearlyIncompressible) return;
  refuse("calibration",
         "tests with free faces are evaluated as incompressible, and confined compression with "
         "poisson = " +
             number_text(poisson),
         "fit the confined tests alone, or choose a poisson of 0.45 or more");
}

void check_tests(const std::vector<HomogeneousTest>& tests, const HomogeneousSettings& settings) {
  if (tests.empty()) refuse("calibration", "there are no tests", "give at least one");
  check_confined(tests, settings.poisson);
  for (const HomogeneousTest& test : tests) {
    if (test.deformation.empty() || test.deformation.size() != test.nominal.size()) {
      refuse(test.name, "deformations and stresses are not equally many", "give pairs");
    }
    if (!test.effect.empty() && (test.effect.size() != test.nominal.size() || test.offset))
      refuse(test.name, "an offset is not fitted to a specimen that is not homogeneous",
             "leave `offset` out");
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

/// A first guess of the shear modulus: the stress over that of a neo-Hookean solid whose shear
/// modulus is one.
double modulus_scale(const std::vector<HomogeneousTest>& tests, double poisson) {
  double above = 0, below = 0;
  const IncompressibleLaw unit("neo-hookean", poisson);
  const double young = 2 * (1 + poisson);
  for (const HomogeneousTest& test : tests) {
    for (std::size_t i = 0; i < test.nominal.size(); ++i) {
      const double g = unit.stress(&young, test.mode, test.deformation[i]);
      above += g * test.nominal[i];
      below += g * g;
    }
  }
  return below > 0 && above > 0 ? above / below : 1;
}

DataScale scale_of(const std::vector<HomogeneousTest>& tests, double poisson) {
  DataScale scale{modulus_scale(tests, poisson), 0};
  for (const HomogeneousTest& test : tests)
    for (const double s : test.deformation)
      scale.invariant = std::max(scale.invariant, first_invariant(test.mode, s));
  return scale;
}

const ConstantInfo* given_in(const HomogeneousSettings& settings, const std::string& name) {
  for (const ConstantInfo& given : settings.constants)
    if (given.name == name) return &given;
  return nullptr;
}

std::string names_of(const std::vector<Constant>& constants) {
  std::string names;
  for (const Constant& constant : constants) names += (names.empty() ? "" : ", ") + constant.name;
  return names;
}

std::vector<Constant> law_constants(const IncompressibleLaw& law, const DataScale& scale,
                                    const HomogeneousSettings& settings, bool wide) {
  std::vector<Constant> out;
  for (const ConstantInfo& info :
       wide ? wide_constants(law, scale) : default_constants(law, scale)) {
    const ConstantInfo* given = given_in(settings, info.name);
    const ConstantInfo& used = given != nullptr ? *given : info;
    out.push_back({used.name, info.is_stress ? "Pa" : "1", used.start, used.low, used.high});
    out.back().linear = info.is_stress;
  }
  for (const ConstantInfo& given : settings.constants) {
    const auto is_it = [&](const Constant& c) { return c.name == given.name; };
    if (std::any_of(out.begin(), out.end(), is_it)) continue;
    refuse("constant '" + given.name + "'", "the law " + std::string(law.name()) + " has no such",
           "its constants are " + names_of(out));
  }
  return out;
}

/// Ogden's terms by ascending exponents: every order of them is the same law.
void sort_terms(std::vector<double>& c, std::size_t terms) {
  std::vector<std::pair<double, double>> pairs;
  for (std::size_t i = 0; i < terms; ++i) pairs.emplace_back(c[2 * i + 1], c[2 * i]);
  std::sort(pairs.begin(), pairs.end());
  for (std::size_t i = 0; i < terms; ++i) {
    c[2 * i] = pairs[i].second;
    c[2 * i + 1] = pairs[i].first;
  }
}

/// Residuals of all samples, and their derivatives by the constants.
std::function<bool(const double*, double*, double*)> model_of(const HomogeneousProblem& problem,
                                                              const IncompressibleLaw& law) {
  const std::size_t n = law.constants().size(), all = problem.squares.constants.size();
  std::vector<std::size_t> column(problem.offset.size(), 0);  // of the offset of a test
  for (std::size_t t = 0, next = n; t < column.size(); ++t)
    if (problem.offset[t]) column[t] = next++;
  return [samples = problem.samples, law, n, all, column](const double* c, double* r, double* J) {
    std::vector<double> slope(n);
    for (std::size_t row = 0; row < samples.size(); ++row) {
      const WeightedSample& s = samples[row];
      const std::size_t offset = column[s.test];
      const double P = law.stress(c, s.mode, s.deformation, J == nullptr ? nullptr : slope.data());
      r[row] = (P + (offset > 0 ? c[offset] : 0) - s.stress) * s.factor;
      if (!std::isfinite(r[row])) return false;
      if (J == nullptr) continue;
      std::fill(J + row * all, J + (row + 1) * all, 0.0);
      for (std::size_t k = 0; k < n; ++k) J[row * all + k] = slope[k] * s.factor;
      if (offset > 0) J[row * all + offset] = s.factor;
    }
    return true;
  };
}

}  // namespace

double rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

std::vector<std::vector<double>> HomogeneousProblem::starts(const IncompressibleLaw& law,
                                                            const HomogeneousSettings& settings,
                                                            bool any_sign) const {
  std::vector<std::vector<double>> out =
      scanned_starts(law, samples, {.any_sign = any_sign, .offset = offset});
  const std::size_t scanned = out.size();
  for (std::size_t i = 0; i < scanned && !settings.constants.empty(); ++i) {
    std::vector<double> start = out[i];
    for (std::size_t k = 0; k < start.size(); ++k)
      if (given_in(settings, squares.constants[k].name) != nullptr)
        start[k] = squares.constants[k].start;
    out.push_back(start);
  }
  std::vector<double>& plain = out.emplace_back();
  for (std::size_t k = 0; k < law.constants().size(); ++k)
    plain.push_back(squares.constants[k].start);
  for (std::vector<double>& start : out) start.resize(squares.constants.size(), 0);
  return out;
}

HomogeneousProblem problem_of(const std::vector<HomogeneousTest>& tests,
                              const HomogeneousSettings& settings, const IncompressibleLaw& law,
                              bool wide) {
  check_tests(tests, settings);
  HomogeneousProblem problem;
  LeastSquares& squares = problem.squares;
  squares.constants = law_constants(law, scale_of(tests, settings.poisson), settings, wide);
  squares.confidence = settings.confidence;
  squares.known_scatter = settings.weighting == Weighting::Uncertainty;
  squares.max_iterations = kMostIterations;
  squares.tolerance = kTolerance;
  for (const HomogeneousTest& test : tests) {
    squares.residuals += test.nominal.size();
    squares.series.push_back(test.nominal.size());
  }
  const double mean = static_cast<double>(squares.residuals) / static_cast<double>(tests.size());
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const HomogeneousTest& test = tests[t];
    const double deviation = deviation_of(test, settings.weighting, mean);
    squares.deviations.insert(squares.deviations.end(), test.nominal.size(), deviation);
    const std::vector<double> factor = factors(test, settings);
    for (std::size_t i = 0; i < test.nominal.size(); ++i) {
      const double effect = test.effect.empty() ? 1 : test.effect[i];
      problem.samples.push_back({test.mode, test.deformation[i], test.nominal[i] / effect,
                                 deviation * factor[i] * effect, t});
    }
    problem.offset.push_back(test.offset);
    if (test.offset)
      squares.constants.push_back({"offset of " + test.name, "Pa", 0, -kInfinity, kInfinity,
                                   /*may_vanish=*/true, false,
                                   /*linear=*/true});
  }
  if (law.name().starts_with("ogden") && settings.constants.empty())
    squares.canonical = [terms = law.constants().size() / 2](std::vector<double>& c) {
      sort_terms(c, terms);
    };
  squares.model = model_of(problem, law);
  return problem;
}

}  // namespace palpate::calibrate
