// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "mesher/mesher.hpp"
#include "mesher/surface.hpp"
#include "mesher/text.hpp"

namespace palpate::mesher {

/// Read a surface, scale it to metres, do the harmless repairs of `tidy`, turn its faces outward,
/// split polygons into triangles, and refuse everything that does not enclose one volume.
/// @throws Error(Geometry), `where` being the path.
Surface read_surface(const SurfaceFile& file, const Log& log);

}  // namespace palpate::mesher
