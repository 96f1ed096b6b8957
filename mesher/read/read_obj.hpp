// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "mesher/geometry/soup.hpp"

namespace palpate::mesher {

/// Reads the vertices, faces and names of a Wavefront OBJ file and skips everything else: CGAL's
/// reader stops at the first keyword it does not know, and sculpting programs write many.
/// Negative (relative) indices are resolved. An index of no vertex becomes one that `check_entries`
/// refuses.
/// @throws Error(Geometry) naming the line of a vertex without three numbers or a face whose index
///   is no number.
Soup read_obj(const std::filesystem::path& path);

}  // namespace palpate::mesher
