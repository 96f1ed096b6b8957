// SPDX-License-Identifier: AGPL-3.0-or-later
// Choice of the response vertices to compute when the others are interpolated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/body.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

/// Sites of which no two are closer than `spacing` (m), such that no other site is farther than
/// that from all of them. Starts with the first site, then takes the farthest one
/// [Gonzalez 1985]. Ascending.
std::vector<std::int32_t> spread_sites(const Body& body, double spacing);

/// Sites with the largest expected relative error of interpolation above `target`, at most `most`,
/// returned ascending.
/// The expected error at a vertex is max_k e_k (d/h_k)^2: d is its distance from the nearest
/// computed vertex; e_k is the leave-one-out error of the k-th of the three nearest computed
/// vertices, and h_k the mean distance of that one from its own three nearest. The interpolation
/// error of a smooth field decreases like the square of the gap. Each chosen site reduces d of the
/// others.
/// @param computed vertices that were computed, successfully or not, ascending.
std::vector<std::int32_t> next_sites(const Body& body, const std::vector<std::int32_t>& computed,
                                     const Library& library, double target, std::size_t most);

}  // namespace palpate::fitting
