// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/geometry/soup.hpp"

namespace palpate::mesher {

/// The vertices, faces and triangle strips of a PLY file, as text or binary of either byte order
/// [Turk 1994]. Other elements and properties are skipped.
/// A colour is the name of a face, "#ff0000" for red: its own, or that of most of its corners.
/// Faces without a colour, and those whose corners differ, have no name.
/// @throws Error(Geometry) with the line, or the byte behind the header of a binary file, for an
///   unknown format or type, a number that is none or not finite, or a file that ends early.
Soup read_ply(std::string_view bytes, const std::string& file);

}  // namespace palpate::mesher
