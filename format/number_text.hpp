// SPDX-License-Identifier: Apache-2.0
// Numbers as a reader wants them: as many significant digits for a small body as for a large one.
#pragma once

#include <concepts>
#include <string>

namespace palpate {

/// Three significant digits, or as many as asked for, without an exponent from 1e-4 to 1e6:
/// "1240", "12.4", "0.00124". Whole digits are never cut. "unknown" for NaN.
std::string number_text(double value, int digits = 3);

/// A value >= 0 with four significant digits that is not below it: an upper bound stays one.
std::string rounded_up_text(double value);

/// "12.4 N", "0.124 mN" or "3.4 uN".
std::string force_text(double newtons);

/// "12.4 mm", "3.40 um" or "5.00 nm".
std::string length_text(double metres);

/// "12.4 J", "12.4 mJ", "0.124 mJ" or "3.40 nJ".
std::string energy_text(double joules);

/// Two significant digits of a fraction: "0.43 %", "17 %"; "below 0.01 %" for what is less.
std::string percent_text(double fraction);

/// "1 site", "2 sites": `things` is the plural.
template <std::integral Count>
std::string count_text(Count count, const std::string& thing, const std::string& things) {
  return std::to_string(count) + " " + (count == 1 ? thing : things);
}
/// The same for a plural in s.
template <std::integral Count>
std::string count_text(Count count, const std::string& thing) {
  return count_text(count, thing, thing + "s");
}

}  // namespace palpate
