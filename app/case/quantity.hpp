// SPDX-License-Identifier: AGPL-3.0-or-later
// Quantities of the case file: text with a unit outside, SI inside.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::app {

/// What a dimensional key of the case file measures.
enum class Dimension {
  Length,
  Pressure,
  Angle,
  Force,
  Frequency,
  Mass,
  Damping,
  Stiffness,
  Speed,
  Time,
  Compliance,
  FoundationStiffness,
  Acceleration,
  Density
};

struct Unit {
  std::string_view symbol;
  double si;  ///< value of one unit in SI
};

std::string_view dimension_name(Dimension dimension);  ///< "length", ...
/// Accepted units. The first is the one used to print, the last is the SI unit.
std::span<const Unit> units_of(Dimension dimension);
std::vector<std::string_view> unit_symbols(Dimension dimension);
std::string unit_list(Dimension dimension);  ///< "N/m, ...", for messages

/// Outcome of parse_quantity: why a text is not a quantity is told to the user by the caller, who
/// knows the key and the line.
enum class QuantityFault { None, NoNumber, NoUnit, WrongUnit };

struct ParsedQuantity {
  double value = 0;  ///< SI
  QuantityFault fault = QuantityFault::None;
};

/// "10 mm" -> 0.01. The number is a plain decimal; blanks around the parts do not matter.
ParsedQuantity parse_quantity(std::string_view text, Dimension dimension);

/// A text that parse_quantity turns back into exactly `value`: in the preferred unit when that is
/// exact, in SI otherwise.
std::string print_quantity(double value, Dimension dimension);

/// Shortest text that reads back as exactly `value`; always a TOML float (with a point or
/// exponent).
std::string print_number(double value);

}  // namespace palpate::app
