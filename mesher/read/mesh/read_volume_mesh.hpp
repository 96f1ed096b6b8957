// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "mesher/geometry/text.hpp"
#include "mesher/settings.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

/// Reads the mesh of a file by its ending, checks it (`assemble`) and gives its groups the regions
/// of the settings.
/// @throws Error(Geometry) for a file that cannot be used, with the place; Error(Configuration) for
///   a group that the file does not have.
VolumeMesh read_volume_mesh(const VolumeMeshFile& file, const Log& log);

}  // namespace palpate::mesher
