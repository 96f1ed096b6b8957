// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/geometry/soup.hpp"

namespace palpate::mesher {

/// The vertices and faces of an OFF file of text; what follows them on their lines, such as colours
/// and normals, is skipped. Numbers may be spread over lines; `#` begins a comment.
/// @throws Error(Geometry) with the line, for another kind of file, a number that is none or not
///   finite, an index of no vertex, or a file that ends early.
Soup read_off(std::string_view bytes, const std::string& file);

}  // namespace palpate::mesher
