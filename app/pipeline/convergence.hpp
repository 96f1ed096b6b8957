// SPDX-License-Identifier: AGPL-3.0-or-later
// Discretisation error of the forces of a case, by mesh refinement.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/pipeline/events.hpp"
#include "app/pipeline/richardson.hpp"
#include "app/pipeline/workspace.hpp"

namespace palpate::app {

/// One force on all meshes, that of the case first.
struct ConvergenceRow {
  std::int32_t vertex = -1;
  std::string quantity;        ///< "normal force at 6 mm"
  std::vector<double> forces;  ///< N; NaN where a path is not complete
  Extrapolation limit;
};

struct ConvergenceTable {
  std::vector<double> element_sizes;  ///< m, of the boundary facets, descending
  std::vector<std::int64_t> nodes;    ///< corner nodes of the bodies
  std::vector<ConvergenceRow> rows;
};

/// Element sizes of `levels` meshes, m: that of the case, then each about 1.4 times finer, such
/// that a patch is divided into a whole number of facets.
std::vector<double> finer_element_sizes(double patch_spacing, double element_size, int levels);

/// Meshes the case on `levels` meshes, presses the sites `wanted` (empty: three, spread over all),
/// reports the limits of the forces and writes them to `convergence.csv`. The artifacts are
/// unchanged.
/// @throws Error(Configuration) for fewer than three levels, a vertex that is not a site, or a body
///   that is read as a mesh or an image.
ConvergenceTable run_convergence(const Workspace& space, int levels,
                                 const std::vector<std::int32_t>& wanted, const EventSink& emit);

std::string convergence_csv(const ConvergenceTable& table);

}  // namespace palpate::app
