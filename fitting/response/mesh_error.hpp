// SPDX-License-Identifier: AGPL-3.0-or-later
// The error that the mesh leaves in the forces of all sites, from the few that were pressed on a
// finer mesh as well.
#pragma once

#include <cstddef>
#include <vector>

#include "format/curves.hpp"
#include "format/numbers.hpp"

namespace palpate::fitting {

/// Number of differences that bound the error of a sample.
inline constexpr std::size_t kDifferencesOfBound = 19;

/// Sets mesh_error of the samples of all paths, and its confidence, from the mesh_difference of
/// some paths of the same kind. Relative to the force, or to a hundredth of the largest one of its
/// path if that is larger, it is the largest of the 19 differences at the nearest resolution of the
/// contact (by the ratio of facets_in_contact): of 20 values in random order the last is the
/// largest in one of 20 cases. With fewer differences all are taken, and the confidence is lower:
/// it is that of the kind that has the fewest.
/// `at_edge`: for each response vertex whether it is pressed at a sharp edge; empty: none is. Sites
/// at edges are bounded by the differences there, the others by theirs; by all of them where their
/// own kind of site has none, which is worth no confidence: it is 0.
void bound_mesh_errors(Curves& curves, const std::vector<bool>& at_edge = {});

/// Median and largest mesh_error of the paths of a kind, relative as above: at their ends, and at
/// their first samples.
struct MeshErrorSummary {
  double median_at_end = kUnknown, worst_at_end = kUnknown;
  double median_at_first = kUnknown, worst_at_first = kUnknown;
};
MeshErrorSummary mesh_error_summary(const Curves& curves, PathKind kind = PathKind::Normal);

}  // namespace palpate::fitting
