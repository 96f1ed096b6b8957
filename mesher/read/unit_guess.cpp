// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/unit_guess.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "mesher/read/file/file.hpp"

namespace palpate::mesher {
namespace {

constexpr double kOrgan = 0.15;    // m
constexpr double kLargest = 2;     // m
constexpr double kNearlyAs = 0.3;  // decades

/// Decades that a unit is preferred by.
double preference(std::string_view symbol) {
  if (symbol == "mm") return 0.15;
  if (symbol == "dm") return -0.2;
  return 0;
}

/// The smaller, the likelier; in decades.
double unlikeliness(double raw, const Unit& unit) {
  constexpr double too_large = 10;
  const double size = raw * unit.si;
  return std::abs(std::log10(size / kOrgan)) - preference(unit.symbol) +
         (size > kLargest ? too_large : 0);
}

std::optional<Unit> unit_named(std::string_view symbol) {
  for (const Unit& unit : units_of(Dimension::Length))
    if (unit.symbol == symbol) return unit;
  return {};
}

/// The unit that a word of a comment means.
std::optional<Unit> unit_of_word(std::string_view word) {
  constexpr auto names = std::to_array<std::pair<std::string_view, std::string_view>>(
      {{"millimet", "mm"}, {"centimet", "cm"}, {"micromet", "um"}, {"inch", "in"}, {"met", "m"}});
  for (const auto& [beginning, symbol] : names)
    if (word.starts_with(beginning)) return unit_named(symbol);
  return unit_named(word);
}

}  // namespace

UnitGuess guess_unit(double raw) {
  const auto all = units_of(Dimension::Length);
  std::vector<Unit> units(all.begin(), all.end());
  std::stable_sort(units.begin(), units.end(), [raw](const Unit& a, const Unit& b) {
    return unlikeliness(raw, a) < unlikeliness(raw, b);
  });
  UnitGuess guess{units[0], {}};
  if (unlikeliness(raw, units[1]) < unlikeliness(raw, units[0]) + kNearlyAs)
    guess.another = units[1];
  return guess;
}

std::optional<Unit> stated_unit(std::string_view first_bytes) {
  const std::string text = lower(std::string(first_bytes));
  if (text.find("3d slicer output") != std::string::npos) return unit_named("mm");
  static const std::regex statement("\\bunits?(\\s*[=:]|\\s)\\s*\"?([a-z]+)");
  std::smatch found;
  for (auto from = text.begin(); std::regex_search(from, text.end(), found, statement);
       from = found[2].first) {  // the word may itself be "unit"
    const std::string word = found[2].str();
    // "0.5 units in the z direction" states nothing.
    const bool is_sentence = found[1].length() == 1 && std::isspace(*found[1].first) != 0;
    if (is_sentence && word == "in") continue;
    if (const auto unit = unit_of_word(word)) return unit;
  }
  return {};
}

}  // namespace palpate::mesher
