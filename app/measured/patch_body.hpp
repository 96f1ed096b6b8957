// SPDX-License-Identifier: AGPL-3.0-or-later
// A body of measurements alone: the surface that was touched, and nothing of its inside.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/measured/sidecar.hpp"
#include "format/body.hpp"

namespace palpate::app {

struct PatchBody {
  Body body;                ///< without provenance
  double spacing = 0;       ///< m, median distance of a site to the nearest one
  double steepest = 0;      ///< rad, largest angle of a facet to the mean normal
  double largest_turn = 0;  ///< rad, largest angle of a measured normal to a facet
  std::vector<std::string> warnings;
  std::vector<std::string> refused;  ///< sites, and records as a whole, that are not in the surface
};

/// Whether the records say where they were made and along which normal, so that they need no body.
bool makes_body(const Sidecar& sidecar);

/// The response surface through the contact points of all batches; the press directions are the
/// measured normals. A site that cannot be used is no vertex.
/// @throws Error as mesher::make_patch; where no batch can be used as measured::split_batch; for a
/// sidecar with presses or logs that are no batch.
PatchBody patch_body(const std::filesystem::path& sidecar_file, const std::string& tool = {});

}  // namespace palpate::app
