// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "mesher/soup.hpp"

namespace palpate::mesher {

/// The vertices and faces of a Wavefront OBJ file; everything else in it is skipped. CGAL's reader
/// gives up at the first keyword it does not know, and sculpting programs write many. Negative
/// (relative) indices are resolved; one that names no vertex is left out of range for
/// `check_entries` to count.
/// @throws Error(Geometry) naming the line of a vertex without three numbers or a face whose index
///   is no number.
Soup read_obj(const std::filesystem::path& path);

}  // namespace palpate::mesher
