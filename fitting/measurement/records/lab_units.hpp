// SPDX-License-Identifier: AGPL-3.0-or-later
// The unit symbols that testing machines write into their files.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate::measured {

/// What a column of a measured table holds.
enum class Quantity { Time, Length, Force, Stress, Ratio };

std::string_view quantity_name(Quantity quantity);  ///< "time", "length", ...

/// Value in SI of one unit with this symbol; nothing when the symbol is not a unit of the quantity.
/// Blanks around the symbol do not matter. "%" is a ratio of 0.01.
std::optional<double> unit_in_si(std::string_view symbol, Quantity quantity);

/// True when the symbol is a unit of some quantity that laboratories record, those that palpate
/// does not use (deg, V, degC) included.
bool is_lab_unit(std::string_view symbol);

std::string lab_unit_list(Quantity quantity);  ///< "mm, um, ...", for messages

}  // namespace palpate::measured
