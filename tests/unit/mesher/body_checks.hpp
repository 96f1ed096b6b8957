// SPDX-License-Identifier: AGPL-3.0-or-later
// Conditions that every body meets, computed from its records alone.
#pragma once

#include "format/body.hpp"

namespace palpate::mesher::test {

double volume_of_region(const Body& body, std::int32_t region);  ///< of all regions for -1
double boundary_volume(const Body& body);                        ///< by the divergence theorem
double boundary_area(const Body& body);
int euler_characteristic(const Body& body);  ///< V - E + F of the boundary facets

/// Index ranges, positive tetrahedra, each boundary edge used once in each direction, the boundary
/// being exactly the faces of one tetrahedron, volumes that agree, unit directions, sites that are
/// not fixed, and the two conditions of the runtime on directions.
void expect_sound(const Body& body);

/// Each response triangle divided into n x n facets that share its corners, nothing left over.
void expect_nested(const Body& body, int n);

}  // namespace palpate::mesher::test
