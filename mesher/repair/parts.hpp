// SPDX-License-Identifier: AGPL-3.0-or-later
// The connected parts of a surface, and which of them are kept.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/surface.hpp"
#include "mesher/repair/points.hpp"
#include "mesher/repair/repair_settings.hpp"

namespace palpate::mesher {

/// The area of the largest part over that of all; 0 without faces.
double largest_fraction(const Surface& surface);

/// Place, area and volume of each part, the largest area first.
std::vector<std::string> describe_parts(const Surface& surface);

/// Removes parts that are small against the extent (m) or in area, and with largest_part all parts
/// but that of the largest area.
/// @throws FaultySurface with the size and place of each part where several remain.
void keep_parts(Surface& surface, const RepairSettings& settings, double extent,
                const std::string& where, Steps& steps);

}  // namespace palpate::mesher
