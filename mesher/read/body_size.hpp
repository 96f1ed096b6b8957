// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "mesher/geometry/text.hpp"

namespace palpate::mesher {

/// Compares the largest dimension of a body with sizes that samples and organs have.
/// @param raw the largest dimension in units of the file
/// @param unit m per unit of the file
/// @throws Error(Geometry) outside 10 um .. 10 m, with the unit that looks likely. A size below
///   1 mm or above 2 m is logged as unusual.
void check_body_size(double raw, double unit, const std::string& where, const Log& log);

}  // namespace palpate::mesher
