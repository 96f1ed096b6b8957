// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/starts.hpp"

#include <algorithm>
#include <array>

#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

/// Lower bound of a modulus, of the one that the data suggest.
constexpr double kSmallModulus = 1e-6;

struct StartRange {
  double start, low, high;
};

int terms_of(std::string_view ogden) {
  return ogden.back() - '0';
}

std::vector<StartRange> ogden_ranges(int terms, double scale) {
  constexpr std::array<double, 3> exponents{2, 6, -3};
  constexpr double kLargestExponent = 99.99;  // the table leaves 100 out
  std::vector<StartRange> ranges;
  for (int i = 0; i < terms; ++i) {
    // Each term stiffens: mu_i >= 0 for all i makes the law stable [Ogden 1984, sec. 7.2].
    ranges.push_back({scale / terms, 0, kInfinity});
    ranges.push_back({exponents[static_cast<std::size_t>(i)], -kLargestExponent, kLargestExponent});
  }
  return ranges;
}

/// Starts and bounds in the order of the constants.
std::vector<StartRange> ranges_of(const IncompressibleLaw& law, const DataScale& data) {
  const std::string_view name = law.name();
  const double scale = data.modulus, small = kSmallModulus * scale;
  const StartRange modulus{scale, small, kInfinity};
  const StartRange any{1e-3 * scale, -kInfinity, kInfinity};
  if (name == "mooney-rivlin") return {{0.4 * scale, 0, kInfinity}, {0.1 * scale, 0, kInfinity}};
  if (name == "mooney-rivlin-5")
    return {
        {0.4 * scale, -kInfinity, kInfinity}, {0.1 * scale, -kInfinity, kInfinity}, any, any, any};
  if (name == "yeoh") {
    return {{0.5 * scale, small, kInfinity},
            {-1e-3 * scale, -kInfinity, kInfinity},
            {1e-5 * scale, -kInfinity, kInfinity}};
  }
  if (name == "demiray-fung") return {modulus, {0.1, 1e-6, 999}};
  if (name == "veronda-westmann") return {modulus, {0.5, 1e-6, 999}};
  if (name == "gent") {
    const double least = std::max(1e-3, (1 + 1e-6) * data.invariant);
    return {modulus, {2 * std::max(50.0, data.invariant), least, 1e6 * std::max(1.0, least)}};
  }
  if (name == "arruda-boyce") return {modulus, {4, 1.01, 1e3}};
  if (name.starts_with("ogden")) return ogden_ranges(terms_of(name), scale);
  const double young = 2 * (1 + law.poisson());  // neo-hookean, over the shear modulus
  return {{young * scale, young * small, kInfinity}};
}

}  // namespace

std::vector<ConstantInfo> default_constants(const IncompressibleLaw& law, const DataScale& scale) {
  const std::vector<StartRange> ranges = ranges_of(law, scale);
  std::vector<ConstantInfo> constants;
  for (const fem::LawConstant& constant : law.constants()) {
    const StartRange& range = ranges[constants.size()];
    constants.push_back(
        {std::string(constant.name), constant.is_stress, range.start, range.low, range.high});
  }
  return constants;
}

std::vector<ConstantInfo> wide_constants(const IncompressibleLaw& law, const DataScale& scale) {
  std::vector<ConstantInfo> constants = default_constants(law, scale);
  const std::vector<fem::LawConstant> table = law.constants();
  for (std::size_t i = 0; i < constants.size(); ++i) {
    const bool any_sign = table[i].is_stress && table[i].low == -kInfinity;
    if (any_sign) constants[i].low = -kInfinity;
  }
  return constants;
}

}  // namespace palpate::calibrate
