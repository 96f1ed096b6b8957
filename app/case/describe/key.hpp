// SPDX-License-Identifier: AGPL-3.0-or-later
// What a key of a case file is: name, meaning, unit and accepted values.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/case/names.hpp"
#include "app/case/quantity.hpp"

namespace palpate::app {

/// Values that a key accepts. An open end is excluded.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  constexpr bool contains(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }
};

inline constexpr Range kAny{};
inline constexpr Range kPositive{.low = 0, .low_open = true};
inline constexpr Range kNotNegative{.low = 0};

enum class Presence { Optional, Required };

struct Key {
  std::string_view name;
  std::string_view about;
  Presence presence = Presence::Optional;
  Range range = kAny;
};

using Choices = std::vector<std::string_view>;

/// What a case file writes for kAuto.
inline constexpr std::string_view kAutoText = "auto";

constexpr auto kRequired = Presence::Required;
constexpr auto kOptional = Presence::Optional;

/// A value that a case file writes as one of the names of a table.
template <class V, class T, std::size_t N>
void describe_choice(V& v, T& value, const Key& key, const std::array<Named<T>, N>& table) {
  std::string name(name_in(table, value));
  v.text(name, key, names_in(table));
  for (const Named<T>& entry : table)
    if (entry.name == name) value = entry.value;
}

/// The length of the unit of a file, m, written by its symbol.
template <class V>
void describe_length_unit(V& v, double& metres, const Key& key) {
  const auto units = units_of(Dimension::Length);
  const auto same =
      std::find_if(units.begin(), units.end(), [&](const Unit& unit) { return unit.si == metres; });
  std::string symbol(same == units.end() ? std::string_view{} : same->symbol);
  v.text(symbol, key, unit_symbols(Dimension::Length));
  for (const Unit& unit : units)
    if (unit.symbol == symbol) metres = unit.si;
}

template <class V>
void describe_path(V& v, std::filesystem::path& path, const Key& key) {
  std::string text = path.string();
  v.text(text, key);
  path = text;
}

/// The alternative A of a variant; it becomes that alternative, with default values, if it was not.
template <class A, class Variant>
A& alternative(Variant& variant) {
  if (!std::holds_alternative<A>(variant)) variant.template emplace<A>();
  return std::get<A>(variant);
}

}  // namespace palpate::app
