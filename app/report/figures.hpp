// SPDX-License-Identifier: AGPL-3.0-or-later
// The numbers of the report that are computed rather than copied from an artifact.
#pragma once

#include <cstdint>
#include <vector>

#include "format/curves.hpp"
#include "format/library.hpp"
#include "format/numbers.hpp"

namespace palpate::report {

/// f^z(d)/d of a straight press as it is rendered, N/m; NaN where the vertex has no response.
double secant_stiffness(const NodeResponse& response, ResponseKind kind, double d);

/// Largest fit error over the largest sampled force of the same coordinate; NaN without samples.
double relative_error(double error, double peak);

/// Largest sampled |force along the path| of each coordinate, N; 0 without samples.
struct PeakForce {
  double normal = 0;
  double lateral = 0;
};
PeakForce peak_force(const SiteCurves& site, const Vec3& inward);

/// Vertices shown by default; -1 when no vertex has a response.
struct ChosenVertices {
  std::int32_t softest = -1;
  std::int32_t median = -1;
  std::int32_t stiffest = -1;
  std::int32_t worst_fit = -1;
};
/// By secant stiffness at depth d, and by the larger of the two relative fit errors.
ChosenVertices choose_vertices(const Library& library, const std::vector<PeakForce>& peaks,
                               double d);

/// Energy balance at the end of one path: the work of the tool must be the energy stored in the
/// body and, where that is known, in the springs of the contact.
struct PathBalance {
  std::int32_t vertex = -1;
  PathKind kind = PathKind::Normal;
  double work = 0;        ///< J
  double energy = 0;      ///< J
  double difference = 0;  ///< (work - energy) / max(|work|, |energy|)
};
/// One entry for each path whose last sample has any energy.
std::vector<PathBalance> path_balances(const Curves& curves);

struct CampaignFigures {
  std::int32_t complete = 0, partial = 0, failed = 0;
  double deepest = 0;               ///< m, deepest converged sample of a normal path
  double max_force = 0;             ///< N, largest |force| of any sample
  double volume_change = kUnknown;  ///< m^3, of the sample where the body changes most
  double min_jacobian = kUnknown;   ///< smallest det F of any sample
  double cpu_seconds = 0;
};
CampaignFigures campaign_figures(const Curves& curves);

/// Nearest-rank percentile of values (reordered); `fraction` in 0..1. Empty input gives 0.
double percentile(std::vector<double>& values, double fraction);

/// Median length of the distinct edges of a triangulation, m.
double median_edge(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles);

}  // namespace palpate::report
