// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/geometry/soup.hpp"

namespace palpate::mesher {

/// Whether the bytes are an STL file of text: binary ones may begin with "solid" too.
bool is_text_stl(std::string_view bytes);

/// Reads an STL file of text. Each solid that has a name gives it to its faces.
/// @throws Error(Geometry) with the line.
Soup read_text_stl(std::string_view bytes, const std::string& file);

}  // namespace palpate::mesher
