// SPDX-License-Identifier: AGPL-3.0-or-later
// `palpate compare --fem`: a library against direct solutions at hold-out points.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/pipeline/workspace.hpp"

namespace palpate::app {

struct FidelityOptions {
  int off_node = 24, at_node = 8;
  std::uint32_t seed = 1;
  double floor_fraction = 0.01;  ///< of the force of the body, see fidelity::relative_floor
  double floor = 0;              ///< N, instead of the fraction; 0: the fraction
  bool finer_mesh = false;  ///< direct presses on a finer mesh: counts the error of the mesh too
  /// Libraries compared with the same direct solutions; empty: the library of the case.
  std::vector<std::filesystem::path> libraries;
};

/// Presses the body of the case at points drawn on the surface of the first library, directly by
/// finite elements and through the runtime, and writes fidelity.json, fidelity.txt and
/// fidelity-states.csv. @return false when a direct solution failed.
bool run_fidelity(const Workspace& space, const FidelityOptions& options);

}  // namespace palpate::app
