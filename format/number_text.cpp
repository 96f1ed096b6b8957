// SPDX-License-Identifier: Apache-2.0
#include "format/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace palpate {
namespace {

constexpr double kSmallest = 1e-4, kLargest = 1e6;  // written without an exponent

std::string printed(const char* format, int precision, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, precision, value);
  return text.data();
}

/// Exponent of the first digit of `value` once it is rounded to so many digits.
int exponent_of(double value, int digits) {
  const std::string rounded = printed("%.*e", digits - 1, value);
  return std::atoi(rounded.c_str() + rounded.find('e') + 1);
}

}  // namespace

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "unknown";
  if (std::isinf(value)) return value > 0 ? "infinite" : "-infinite";
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size < kSmallest || size >= kLargest) return printed("%.*e", digits - 1, value);
  return printed("%.*f", std::max(0, digits - 1 - exponent_of(value, digits)), value);
}

std::string rounded_up_text(double value) {
  constexpr int kDigits = 4;
  if (!std::isfinite(value) || value <= 0) return number_text(value, kDigits);
  const double unit = std::pow(10.0, exponent_of(value, kDigits) - (kDigits - 1));
  std::string text = number_text(value, kDigits);
  // The text is at most half a unit below the value: the next one is above it.
  return std::strtod(text.c_str(), nullptr) < value ? number_text(value + 0.75 * unit, kDigits)
                                                    : text;
}

std::string force_text(double newtons) {
  const double size = std::abs(newtons);
  if (size >= 1 || size == 0 || !std::isfinite(size)) return number_text(newtons) + " N";
  if (size >= 1e-3) return number_text(1e3 * newtons) + " mN";
  return number_text(1e6 * newtons) + " uN";
}

std::string energy_text(double joules) {
  const double size = std::abs(joules);
  if (size >= 1) return number_text(joules) + " J";
  if (size >= 1e-4 || size == 0 || !std::isfinite(size)) return number_text(1e3 * joules) + " mJ";
  if (size >= 1e-7) return number_text(1e6 * joules) + " uJ";
  return number_text(1e9 * joules) + " nJ";
}

std::string length_text(double metres) {
  const double size = std::abs(metres);
  if (size >= 1e-4 || size == 0 || !std::isfinite(size)) return number_text(1e3 * metres) + " mm";
  if (size >= 1e-7) return number_text(1e6 * metres) + " um";
  return number_text(1e9 * metres) + " nm";
}

std::string percent_text(double fraction) {
  constexpr double kLeast = 1e-4;
  if (fraction != 0 && std::abs(fraction) < kLeast) return "below 0.01 %";
  return number_text(100 * fraction, 2) + " %";
}

}  // namespace palpate
