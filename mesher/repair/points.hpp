// SPDX-License-Identifier: AGPL-3.0-or-later
// Repairs of faces that need no neighbourhood: points that differ by noise, T-junctions.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/soup.hpp"

namespace palpate::mesher {

/// One sentence for each step of a repair that changed something.
using Steps = std::vector<std::string>;

/// Border points nearer than 5e-5 of the extent become one, but never both ends of an edge.
void merge_near_points(Soup& soup, double extent, Steps& steps);

/// A border point in the interior of a border edge becomes a corner of the face at that edge.
void split_t_junctions(Soup& soup, double extent, Steps& steps);

}  // namespace palpate::mesher
