// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/starts.hpp"

#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

constexpr double kSmallModulus = 1e-3;  ///< Pa, lower bound of a modulus

struct Range {
  double start, low, high;
};

int terms_of(std::string_view ogden) {
  return ogden.back() - '0';
}

std::vector<Range> ogden_ranges(int terms, double scale) {
  constexpr std::array<double, 3> exponents{2, 6, -3};
  std::vector<Range> ranges;
  for (int i = 0; i < terms; ++i) {
    // Each term stiffens: mu_i > 0 for all i makes the law stable [Ogden 1984, sec. 7.2].
    ranges.push_back({scale / terms, kSmallModulus, kInfinity});
    ranges.push_back({exponents[static_cast<std::size_t>(i)], -100, 100});
  }
  return ranges;
}

/// Starts and bounds in the order of the constants.
std::vector<Range> ranges_of(const IncompressibleLaw& law, double scale) {
  const std::string_view name = law.name();
  const Range modulus{scale, kSmallModulus, kInfinity};
  const Range first{0.4 * scale, 0, kInfinity}, second{0.1 * scale, 0, kInfinity};
  const Range any{1e-3 * scale, -kInfinity, kInfinity};
  if (name == "mooney-rivlin") return {first, second};
  if (name == "mooney-rivlin-5") return {first, second, any, any, any};
  if (name == "yeoh") {
    return {{0.5 * scale, kSmallModulus, kInfinity},
            {-1e-3 * scale, -kInfinity, kInfinity},
            {1e-5 * scale, -kInfinity, kInfinity}};
  }
  if (name == "demiray-fung") return {modulus, {0.1, 1e-6, 999}};
  if (name == "veronda-westmann") return {modulus, {0.5, 1e-6, 999}};
  if (name == "gent") return {modulus, {100, 1e-3, 1e6}};
  if (name == "arruda-boyce") return {modulus, {4, 1.01, 1e3}};
  if (name.starts_with("ogden")) return ogden_ranges(terms_of(name), scale);
  const double young = 2 * (1 + law.poisson());  // neo-hookean, over the shear modulus
  return {{young * scale, young * kSmallModulus, kInfinity}};
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

/// Exponential laws: the stiffer the exponent, the smaller the modulus at rest. The modulus of
/// Veronda-Westmann is the product C1 C2.
std::vector<std::vector<double>> exponential_starts(double scale, bool product) {
  std::vector<std::vector<double>> starts;
  for (const double exponent : {0.1, 1.0, 4.0, 20.0}) {
    const double mu = scale / (1 + exponent);
    for (const double part : {1.0, 0.03}) {
      starts.push_back({product ? part * mu / exponent : part * mu, exponent});
    }
  }
  return starts;
}

}  // namespace

std::vector<ConstantInfo> default_constants(const IncompressibleLaw& law, double scale) {
  const std::vector<Range> ranges = ranges_of(law, scale);
  std::vector<ConstantInfo> constants;
  for (const fem::LawConstant& constant : law.constants()) {
    const Range& range = ranges[constants.size()];
    constants.push_back(
        {std::string(constant.name), constant.is_stress, range.start, range.low, range.high});
  }
  return constants;
}

std::vector<std::vector<double>> several_starts(const IncompressibleLaw& law, double scale) {
  if (law.name().starts_with("ogden")) return ogden_starts(terms_of(law.name()), scale);
  if (law.name() == "demiray-fung") return exponential_starts(scale, false);
  if (law.name() == "veronda-westmann") return exponential_starts(scale, true);
  return {};
}

}  // namespace palpate::calibrate
