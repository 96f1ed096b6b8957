// SPDX-License-Identifier: AGPL-3.0-or-later
// Quantities of TOML files: text with a unit in the file, SI in memory.
#pragma once

#include <string>
#include <string_view>

#include "format/units.hpp"

namespace palpate::app {

/// Outcome of parse_quantity. The caller, who knows the key and the line, makes the message of it.
enum class QuantityFault { None, NoNumber, NoUnit, WrongUnit };

struct ParsedQuantity {
  double value = 0;  ///< SI
  QuantityFault fault = QuantityFault::None;
};

/// "10 mm" -> 0.01. The number is a decimal; blanks around number and unit are ignored.
ParsedQuantity parse_quantity(std::string_view text, Dimension dimension);

/// Text from which parse_quantity reads exactly `value`: in the preferred unit when that is exact,
/// otherwise in SI.
std::string print_quantity(double value, Dimension dimension);

/// Shortest text that reads back as exactly `value`; always a TOML float (with a point or
/// exponent).
std::string print_number(double value);

}  // namespace palpate::app
