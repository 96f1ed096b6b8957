// SPDX-License-Identifier: AGPL-3.0-or-later
// The unit symbols in the files of testing machines.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "format/units.hpp"

namespace palpate::measured {

/// Value in SI of one unit with this symbol; nothing when the symbol is no unit of the dimension.
/// Blanks around the symbol do not matter. "%" is a ratio of 0.01.
std::optional<double> unit_in_si(std::string_view symbol, Dimension dimension);

/// Whether the symbol is a unit of a quantity that laboratories record, including those that
/// palpate does not use (deg, V, degC).
bool is_record_unit(std::string_view symbol);

std::string record_unit_list(Dimension dimension);  ///< "mm, um, ...", for messages

}  // namespace palpate::measured
