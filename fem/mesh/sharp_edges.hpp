// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "format/body.hpp"

namespace palpate::fem {

/// The edges of the boundary at which the normals of the two facets differ by more than 45 degrees,
/// as the positions of their ends, m.
std::vector<std::array<Vec3, 2>> sharp_edges(const Body& body);

/// For each response vertex whether a sharp edge is within `reach`, m.
std::vector<bool> near_sharp_edges(const Body& body, double reach);

}  // namespace palpate::fem
