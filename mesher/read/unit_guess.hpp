// SPDX-License-Identifier: AGPL-3.0-or-later
// The length unit of a file that does not state it.
#pragma once

#include <optional>
#include <string_view>

#include "format/units.hpp"

namespace palpate::mesher {

struct UnitGuess {
  Unit likely;                  ///< symbol, and m per unit of the file
  std::optional<Unit> another;  ///< one that is nearly as likely
};

/// The units of length by how near they bring the largest dimension to that of an organ, 150 mm, on
/// a logarithmic scale. Where two are alike, millimetres are preferred, the unit of most scanners,
/// and decimetres are not, which few programs write. A size above 2 m counts only where no unit
/// gives a smaller one.
/// @param raw largest dimension in units of the file, positive and finite
UnitGuess guess_unit(double raw);

/// The unit that the first bytes of a surface file state: "File units = inches" in a comment, or
/// the header of 3D Slicer, whose lengths are millimetres.
std::optional<Unit> stated_unit(std::string_view first_bytes);

}  // namespace palpate::mesher
