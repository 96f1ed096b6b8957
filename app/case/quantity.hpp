// SPDX-License-Identifier: AGPL-3.0-or-later
// Quantities of the case file: text with a unit outside, SI inside.
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

/// "10 mm" -> 0.01. The number is a plain decimal; blanks around the parts do not matter.
ParsedQuantity parse_quantity(std::string_view text, Dimension dimension);

/// A text that parse_quantity turns back into exactly `value`: in the preferred unit when that is
/// exact, in SI otherwise.
std::string print_quantity(double value, Dimension dimension);

/// Shortest text that reads back as exactly `value`; always a TOML float (with a point or
/// exponent).
std::string print_number(double value);

}  // namespace palpate::app
