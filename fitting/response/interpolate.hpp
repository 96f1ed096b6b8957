// SPDX-License-Identifier: AGPL-3.0-or-later
// Responses of sites that were not computed, interpolated over the surface, and their errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fitting/response/fit_settings.hpp"
#include "format/body.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

/// Number of nearest computed vertices that the error of an interpolated response is taken from.
inline constexpr std::size_t kErrorNeighbours = 3;

/// Error of interpolating a computed response from its neighbours, itself left out.
struct LeaveOneOutError {
  std::int32_t vertex = -1;
  /// Relative to the force: root mean square over the deflections and both responses, the lateral
  /// one weighted by 0.3, the largest ratio of lateral to normal force within friction.
  double relative = 0;
  double normal = 0;   ///< N, largest difference
  double lateral = 0;  ///< N, largest difference
};

/// One entry for each vertex of status Fitted that has neighbours, ascending.
std::vector<LeaveOneOutError> leave_one_out(const Library& library);

/// Response vertices that may be pressed, ascending.
std::vector<std::size_t> sites_of(const Body& body);

/// Sites that are not among `computed` (ascending).
std::vector<std::size_t> sites_not_computed(const Body& body,
                                            const std::vector<std::int32_t>& computed);

/// Vertices with a fitted response that is nearly as deep as the deepest one. A shorter response
/// would have to be extrapolated.
std::vector<std::size_t> interpolation_donors(const Library& library);

/// Interpolates the responses of the sites that were not computed; status Interpolated. Their
/// errors are the largest leave-one-out errors of the nearest computed vertices.
/// @param computed vertices that were computed, successfully or not, ascending; they are unchanged.
/// @return number of interpolated responses.
std::size_t interpolate_rest(const Body& body, const std::vector<std::int32_t>& computed,
                             const FitSettings& settings, Library& library);

}  // namespace palpate::fitting
