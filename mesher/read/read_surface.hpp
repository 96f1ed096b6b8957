// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "mesher/geometry/soup.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/settings.hpp"

namespace palpate::mesher {

/// The points and faces of a surface file as it lists them, in its unit.
/// @throws Error(Geometry) as `check_entries`, and for a file that cannot be read.
Soup read_faces(const std::filesystem::path& path);

/// Reads a surface, scales it to metres, repairs it as `tidy` and, unless the settings forbid it,
/// `repair` do, splits polygons into triangles and orients them outward. The log states each step.
/// @param on_repair called where `repair` changed the surface; may be empty
/// @throws Error(Geometry), with the path as `where`, for a surface that does not enclose one
///   volume: FaultySurface with the faces, in the unit of the file, where some of them are at
///   fault.
Surface read_surface(const SurfaceFile& file, const Log& log, const OnRepair& on_repair = {});

}  // namespace palpate::mesher
