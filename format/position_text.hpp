// SPDX-License-Identifier: Apache-2.0
// Positions in messages, in the unit in which a reader finds them in the file of the body.
#pragma once

#include <string>

#include "format/units.hpp"
#include "format/vec3.hpp"

namespace palpate {

/// The unit of positions in messages of this process; mm until it is set. Call it before threads
/// start.
void print_positions_in(const Unit& unit);
/// The unit of length of so many metres, in its spelling of case files; mm where there is none.
Unit unit_of_length(double metres);

/// m -> "(12.5, 0, -3) mm": up to six significant digits.
std::string position_text(const Vec3& x);

}  // namespace palpate
