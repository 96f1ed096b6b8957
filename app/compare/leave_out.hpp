// SPDX-License-Identifier: AGPL-3.0-or-later
// What a measured library would say of each of its sites, had that site not been measured.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fitting/measurement/compare/compare.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"

namespace palpate::app {

/// A site and its prediction.
struct LeftOutSite {
  std::int32_t vertex = -1;
  std::vector<double> depth, measured;  ///< m, N: the samples of its press
  std::vector<double> predicted;        ///< N; empty: nothing lies around the site
  std::vector<std::int32_t> from;       ///< vertices that predict it
};

/// Distribution of relative errors, by the nearest rank.
struct ErrorDistribution {
  std::size_t count = 0;
  double median = 0, p95 = 0, worst = 0;
  std::int32_t worst_vertex = -1;
};

struct LeaveOut {
  std::vector<LeftOutSite> sites;
  double floor = 0;  ///< N: errors are relative to the measured force or this, if larger
  ErrorDistribution deepest, all;                        ///< prediction against measurement
  ErrorDistribution neighbours_deepest, neighbours_all;  ///< two sites of one edge
};

/// Fraction of the median of the largest forces below which errors are relative to it.
inline constexpr double kLeaveOutFloor = 0.05;

/// Each site in turn is taken out, the others are triangulated anew, and the response that the
/// runtime would render at its contact point,
///   f(d) = sum n_l g_l(d)
/// with the natural coordinates n_l there, is compared with the samples of its own press. Sites
/// without others all around them, at the border, are not predicted. Differences of neighbours are
/// relative to the mean of both forces, at the depths of one of them.
/// @throws Error(Configuration) when no site is predicted; as mesher::make_patch.
LeaveOut leave_sites_out(const Library& library, const Curves& curves);

/// Measured curves and predictions as two sets, for a comparison of the curves.
struct LeaveOutSets {
  compare::ComparedSet measured, predicted;
};
LeaveOutSets sets_of(const LeaveOut& result, const Library& library, const Curves& curves);

std::string leave_out_text(const LeaveOut& result);
nlohmann::ordered_json leave_out_json(const LeaveOut& result, const Library& library);

}  // namespace palpate::app
