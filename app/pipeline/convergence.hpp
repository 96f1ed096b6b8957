// SPDX-License-Identifier: AGPL-3.0-or-later
// How far the forces of a case are from those of an infinitely fine mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/pipeline/richardson.hpp"
#include "app/pipeline/workspace.hpp"

namespace palpate::app {

/// One force on all meshes, the case's first.
struct ConvergenceRow {
  std::int32_t vertex = -1;
  std::string quantity;        ///< "normal force at 6 mm"
  std::vector<double> forces;  ///< N; NaN where a path did not get there
  Extrapolation limit;
};

struct ConvergenceTable {
  std::vector<double> element_sizes;  ///< m, of the boundary facets, descending
  std::vector<std::int64_t> nodes;    ///< of the bodies, corner nodes
  std::vector<ConvergenceRow> rows;
};

/// The element sizes of `levels` meshes: the case's, and each about 1.4 times finer than the one
/// before, such that a patch is divided into whole numbers of facets.
std::vector<double> finer_element_sizes(double patch_spacing, double element_size, int levels);

/// Mesh and press `sites` (empty: three, spread over all) on `levels` meshes, print the table and
/// write it to `convergence.csv` beside the artifacts, which are left alone.
/// @throws Error(Configuration) for fewer than three levels or a vertex that is no site.
ConvergenceTable run_convergence(const Workspace& space, int levels,
                                 std::vector<std::int32_t> sites);

std::string convergence_csv(const ConvergenceTable& table);

}  // namespace palpate::app
