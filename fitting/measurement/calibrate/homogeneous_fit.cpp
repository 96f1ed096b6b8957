// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/homogeneous_fit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "format/error.hpp"

namespace palpate::calibrate {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastRelative = 0.05;  ///< of the largest stress, under Weighting::Relative

[[noreturn]] void refuse(const std::string& where, const std::string& problem,
                         const std::string& remedy) {
  throw Error(ErrorKind::Configuration, where, problem, remedy);
}

/// A law behind a table of functions, so that laws are chosen by name.
struct Law {
  std::string_view name;
  std::function<std::vector<ConstantInfo>(double scale)> constants;
  /// Further starts of the exponents of several-minima laws, for a modulus `scale`.
  std::function<std::vector<std::vector<double>>(double scale)> starts;
  /// Nominal stress; its derivatives by the constants into `slope` unless null.
  std::function<double(const double* c, Mode mode, double s, double* slope)> stress;
  std::function<double(const double* c, const std::array<double, 3>& stretches)> tangent;
};

template <class Energy>
double stress_of(const double* c, Mode mode, double s, double* slope) {
  constexpr int n = Energy::kConstants;
  using Inner = Dual<double, n>;
  std::array<Inner, n> inner;
  for (int i = 0; i < n; ++i) inner[static_cast<std::size_t>(i)] = Inner(c[i], i);
  const auto energy = [&](const std::array<Dual<Inner, 1>, 3>& l) {
    std::array<Dual<Inner, 1>, n> constants;
    for (std::size_t i = 0; i < n; ++i) constants[i].value = inner[i];
    return Energy{}(constants.data(), l);
  };
  const Inner P = nominal_stress(energy, mode, Inner(s));
  if (slope != nullptr) std::copy(P.slope.begin(), P.slope.end(), slope);
  return P.value;
}

template <class Energy>
double tangent_of(const double* c, const std::array<double, 3>& l) {
  const auto energy = [&]<class T>(const std::array<T, 3>& at) {
    std::array<T, Energy::kConstants> constants;
    for (std::size_t i = 0; i < constants.size(); ++i) constants[i] = T(c[i]);
    return Energy{}(constants.data(), at);
  };
  return least_tangent(energy, l);
}

template <class Energy>
Law law(std::string_view name, std::function<std::vector<ConstantInfo>(double)> constants,
        std::function<std::vector<std::vector<double>>(double)> starts = nullptr) {
  return {name, std::move(constants), std::move(starts), stress_of<Energy>, tangent_of<Energy>};
}

std::vector<ConstantInfo> ogden_constants(int terms, double scale) {
  std::vector<ConstantInfo> out;
  constexpr std::array<double, 3> exponents{2, 6, -3};
  for (int i = 0; i < terms; ++i) {
    const std::string number = terms == 1 ? "" : std::to_string(i + 1);
    // Each term stiffens: mu_i > 0 for all i makes the law stable [Ogden 1984, sec. 7.2].
    out.push_back({"mu" + number, true, scale / terms, kSmallModulus, kInfinity});
    out.push_back({"alpha" + number, false, exponents[static_cast<std::size_t>(i)], -100, 100});
  }
  return out;
}

std::vector<std::vector<double>> ogden_starts(int terms, double scale) {
  const std::vector<std::vector<double>> exponents =
      terms == 1 ? std::vector<std::vector<double>>{{2}, {8}, {-5}, {-20}, {20}}
      : terms == 2
          ? std::vector<std::vector<double>>{{1.5, 5}, {2, -2}, {1.5, -8}, {8, -8}, {4, 12}}
          : std::vector<std::vector<double>>{{1.3, 5, -2}, {1.5, 8, -1}, {2, 10, -4}, {1, 4, 12}};
  std::vector<std::vector<double>> starts;
  for (const auto& alpha : exponents) {
    std::vector<double> start;
    for (std::size_t i = 0; i < alpha.size(); ++i) {
      // High powers act late: give them less of the modulus.
      start.push_back(scale * (i == 0 ? 0.9 : 0.05));
      start.push_back(alpha[i]);
    }
    if (terms == 1) start[0] = scale;
    starts.push_back(start);
  }
  return starts;
}

/// Exponential laws: the stiffer the exponent, the smaller the modulus at rest. Veronda-Westmann's
/// modulus is C1 C2.
std::vector<std::vector<double>> exponential_starts(double scale, bool product) {
  std::vector<std::vector<double>> starts;
  for (const double exponent : {0.1, 1.0, 4.0, 20.0}) {
    const double mu = scale / (1 + exponent);
    for (const double share : {1.0, 0.03}) {
      starts.push_back({product ? share * mu / exponent : share * mu, exponent});
    }
  }
  return starts;
}

const std::vector<Law>& laws() {
  using List = std::vector<ConstantInfo>;
  static const std::vector<Law> table{
      law<NeoHookeanEnergy>("neo-hookean",
                            [](double s) {
                              return List{{"mu", true, s, kSmallModulus, kInfinity}};
                            }),
      law<MooneyRivlinEnergy>(
          "mooney-rivlin",
          [](double s) {
            return List{{"C10", true, 0.4 * s, 0, kInfinity}, {"C01", true, 0.1 * s, 0, kInfinity}};
          }),
      law<YeohEnergy>("yeoh",
                      [](double s) {
                        return List{{"C10", true, 0.5 * s, kSmallModulus, kInfinity},
                                    {"C20", true, -1e-3 * s},
                                    {"C30", true, 1e-5 * s}};
                      }),
      law<OgdenEnergy<1>>(
          "ogden-1", [](double s) { return ogden_constants(1, s); },
          [](double s) { return ogden_starts(1, s); }),
      law<OgdenEnergy<2>>(
          "ogden-2", [](double s) { return ogden_constants(2, s); },
          [](double s) { return ogden_starts(2, s); }),
      law<OgdenEnergy<3>>(
          "ogden-3", [](double s) { return ogden_constants(3, s); },
          [](double s) { return ogden_starts(3, s); }),
      law<DemirayFungEnergy>(
          "demiray-fung",
          [](double s) {
            return List{{"mu", true, s, kSmallModulus, kInfinity}, {"b", false, 0.1, 1e-6, 1e3}};
          },
          [](double s) { return exponential_starts(s, false); }),
      law<VerondaWestmannEnergy>(
          "veronda-westmann",
          [](double s) {
            return List{{"C1", true, s, kSmallModulus, kInfinity}, {"C2", false, 0.5, 1e-6, 1e3}};
          },
          [](double s) { return exponential_starts(s, true); }),
      law<GentEnergy>(
          "gent",
          [](double s) {
            return List{{"mu", true, s, kSmallModulus, kInfinity}, {"Jm", false, 100, 1e-3, 1e6}};
          }),
      law<ArrudaBoyceEnergy>("arruda-boyce", [](double s) {
        return List{{"mu", true, s, kSmallModulus, kInfinity}, {"lambda_m", false, 4, 1.01, 1e3}};
      })};
  return table;
}

const Law& law_named(std::string_view name) {
  for (const Law& candidate : laws()) {
    if (candidate.name == name) return candidate;
  }
  std::string names;
  for (const Law& candidate : laws()) {
    names += (names.empty() ? "" : ", ") + std::string(candidate.name);
  }
  refuse("law '" + std::string(name) + "'", "it is not known", "use one of " + names);
}

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

/// What each residual of a test is divided by, times its weight.
std::vector<double> factors(const HomogeneousTest& test, const HomogeneousSettings& settings) {
  std::vector<double> measured;
  for (std::size_t i = 0; i < test.nominal.size(); ++i) {
    const double ratio = settings.residual == Residual::Cauchy
                             ? cauchy_over_nominal(test.mode, test.deformation[i])
                             : 1;
    measured.push_back(test.nominal[i] * ratio);
  }
  double largest = 0;
  for (const double value : measured) largest = std::max(largest, std::abs(value));
  std::vector<double> out;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double ratio = test.nominal[i] != 0 ? measured[i] / test.nominal[i]
                         : settings.residual == Residual::Cauchy
                             ? cauchy_over_nominal(test.mode, test.deformation[i])
                             : 1;
    double scale = 1;
    switch (settings.weighting) {
      case Weighting::Absolute:
        break;
      case Weighting::PerTest:
        scale = std::max(rms(measured), 1e-300);
        break;
      case Weighting::Relative:
        scale = std::max({std::abs(measured[i]), kLeastRelative * largest, 1e-300});
        break;
      case Weighting::Uncertainty:
        scale = test.uncertainty[i] * ratio;
        break;
    }
    out.push_back(test.weight * ratio / scale);
  }
  return out;
}

/// A first guess of the shear modulus: the stress over the strain measure of a neo-Hookean solid.
double modulus_scale(const std::vector<HomogeneousTest>& tests) {
  double above = 0, below = 0;
  const std::vector<double> unit{1};
  for (const HomogeneousTest& test : tests) {
    for (std::size_t i = 0; i < test.nominal.size(); ++i) {
      const double g = law_stress("neo-hookean", unit, test.mode, test.deformation[i]);
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

StabilityLimit stability_in(const Law& law, const std::vector<double>& c, Mode mode, double low,
                            double high) {
  constexpr int steps = 200;
  StabilityLimit limit{mode, low, high, kUnknown};
  const double rest = rest_of(mode);
  for (const double end : {high, low}) {
    for (int i = 0; i <= steps; ++i) {
      const double s = rest + (end - rest) * i / steps;
      if (law.tangent(c.data(), stretches(mode, s)) > 0) continue;
      limit.unstable_at = s;
      return limit;
    }
  }
  return limit;
}

double largest_strain(const std::vector<HomogeneousTest>& tests) {
  double largest = 0;
  for (const HomogeneousTest& test : tests) {
    for (const double s : test.deformation) {
      for (const double l : stretches(test.mode, s)) {
        largest = std::max(largest, std::abs(std::log(l)));
      }
    }
  }
  return largest;
}

/// A ray of states from uniaxial extension (share 0) over pure shear to uniaxial compression (1):
/// by isotropy the other directions of strain repeat these.
std::array<double, 3> stretches_on_ray(double share, double strain) {
  const double angle = share * std::numbers::pi / 3;
  std::array<double, 3> e;
  for (std::size_t i = 0; i < 3; ++i) {
    e[i] = std::cos(angle - 2 * std::numbers::pi / 3 * static_cast<double>(i));
  }
  const double largest = std::max(std::abs(e[0]), std::abs(e[2]));
  for (double& value : e) value = std::exp(strain / largest * value);
  return e;
}

StabilityOfStates stability_of_states(const Law& law, const std::vector<double>& c, double strain) {
  constexpr int steps = 100, rays = 30;
  StabilityOfStates result{strain, {kUnknown, kUnknown, kUnknown}};
  for (int i = 1; i <= steps; ++i) {
    for (int ray = 0; ray <= rays; ++ray) {
      const auto l = stretches_on_ray(static_cast<double>(ray) / rays, strain * i / steps);
      if (law.tangent(c.data(), l) > 0) continue;
      result.unstable_at = l;
      return result;
    }
  }
  return result;
}

std::vector<Constant> problem_constants(const Law& law, double scale,
                                        const HomogeneousSettings& settings) {
  std::vector<Constant> out;
  for (const ConstantInfo& info : law.constants(scale)) {
    ConstantInfo used = info;
    for (const ConstantInfo& given : settings.constants) {
      if (given.name == info.name) used = given;
    }
    out.push_back({used.name, info.is_stress ? "Pa" : "1", used.start, used.low, used.high});
  }
  for (const ConstantInfo& given : settings.constants) {
    const auto is_it = [&](const Constant& c) { return c.name == given.name; };
    if (std::any_of(out.begin(), out.end(), is_it)) continue;
    refuse("constant '" + given.name + "'", "the law " + std::string(law.name) + " has no such",
           "its first is " + out.front().name);
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

}  // namespace

std::vector<std::string_view> homogeneous_laws() {
  std::vector<std::string_view> names;
  for (const Law& law : laws()) names.push_back(law.name);
  return names;
}

std::vector<ConstantInfo> constants_of(std::string_view law, double scale) {
  return law_named(law).constants(scale);
}

double law_stress(std::string_view law, const std::vector<double>& constants, Mode mode, double s) {
  return law_named(law).stress(constants.data(), mode, s, nullptr);
}

double law_tangent(std::string_view law, const std::vector<double>& constants, Mode mode,
                   double s) {
  return law_named(law).tangent(constants.data(), stretches(mode, s));
}

HomogeneousFit fit_homogeneous(const std::vector<HomogeneousTest>& tests,
                               const HomogeneousSettings& settings) {
  const Law& law = law_named(settings.law);
  check_tests(tests, settings);
  const double scale = modulus_scale(tests);
  LeastSquares problem;
  problem.constants = problem_constants(law, scale, settings);
  problem.confidence = settings.confidence;
  problem.known_scatter = settings.weighting == Weighting::Uncertainty;
  std::vector<std::vector<double>> factor;
  for (const HomogeneousTest& test : tests) {
    factor.push_back(factors(test, settings));
    problem.residuals += test.nominal.size();
    problem.series.push_back(test.nominal.size());
  }
  const std::size_t n = problem.constants.size();
  problem.model = [&](const double* c, double* r, double* J) {
    std::vector<double> slope(n);
    std::size_t row = 0;
    for (std::size_t t = 0; t < tests.size(); ++t) {
      for (std::size_t i = 0; i < tests[t].nominal.size(); ++i, ++row) {
        const double P = law.stress(c, tests[t].mode, tests[t].deformation[i], slope.data());
        r[row] = (P - tests[t].nominal[i]) * factor[t][i];
        if (!std::isfinite(r[row])) return false;
        if (J == nullptr) continue;
        for (std::size_t k = 0; k < n; ++k) J[row * n + k] = slope[k] * factor[t][i];
      }
    }
    return true;
  };
  HomogeneousFit fit;
  const std::string where = "fit of " + settings.law;
  std::vector<std::vector<double>> starts;
  if (law.starts && settings.constants.empty()) starts = law.starts(scale);
  fit.calibration = starts.empty() ? minimise(problem, where) : minimise(problem, starts, where);
  if (settings.profiles) add_profiles(problem, fit.calibration);
  std::vector<double> c;
  for (const Estimate& e : fit.calibration.estimates) c.push_back(e.value);
  for (const HomogeneousTest& test : tests) {
    std::vector<double>& predicted = fit.predicted.emplace_back();
    for (const double s : test.deformation) {
      predicted.push_back(law.stress(c.data(), test.mode, s, nullptr));
    }
    fit.errors.push_back(error_of(test, predicted));
    const auto [low, high] = std::minmax_element(test.deformation.begin(), test.deformation.end());
    const double rest = rest_of(test.mode);
    fit.stability.push_back(
        stability_in(law, c, test.mode, std::min(*low, rest), std::max(*high, rest)));
  }
  fit.all_states = stability_of_states(law, c, largest_strain(tests));
  warn_of_instability(tests, fit);
  // Simple shear at rest: the slope of the stress is the shear modulus.
  constexpr double small = 1e-6;
  fit.shear_modulus = law.stress(c.data(), Mode::SimpleShear, small, nullptr) / small;
  return fit;
}

}  // namespace palpate::calibrate
