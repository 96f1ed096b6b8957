// SPDX-License-Identifier: AGPL-3.0-or-later
// Which response vertices to compute, when the others are to be interpolated from them.
#pragma once

#include <cstdint>
#include <vector>

#include "fitting/fitting.hpp"

namespace palpate::fitting {

/// Sites no two of which are nearer than `spacing` (m), and none of the others farther from all of
/// them than that: the first site, then always the one farthest from those taken [Gonzalez 1985].
std::vector<std::int32_t> spread_sites(const Body& body, double spacing);

/// What the neighbours of a computed response say of it when it is left out.
struct Miss {
  std::int32_t vertex = -1;
  double relative = 0;  ///< of the force, root mean square over the deflections and both responses,
                        ///< the lateral one counted by its share of what is felt without slip
  double normal = 0;    ///< N, largest difference
  double lateral = 0;   ///< N
};

/// One for each vertex of status Fitted that has neighbours, ascending.
std::vector<Miss> leave_one_out(const Library& library);

/// Responses for the sites that were not computed, from those that were; marked Filled, with the
/// misses of the nearest computed ones as their errors. @param computed vertices that were
/// computed, whether with success or not, ascending: they stay as they are.
/// @return how many responses were interpolated.
std::size_t interpolate_rest(const Body& body, const std::vector<std::int32_t>& computed,
                             const FitSettings& settings, Library& library);

/// Sites whose interpolated response is expected to be off by more than `target` (relative), worst
/// first, at most `most`, returned ascending. The expectation at a vertex at the distance d from
/// the nearest computed one is the largest miss of the three nearest computed ones, each times
/// (d/h)^2, h the mean distance of that one from its own three nearest: a smooth field is
/// interpolated with an error that falls like the square of the gap. Each site taken shortens d for
/// the rest.
/// @param computed as above, ascending.
std::vector<std::int32_t> next_sites(const Body& body, const std::vector<std::int32_t>& computed,
                                     const Library& library, double target, std::size_t most);

}  // namespace palpate::fitting
