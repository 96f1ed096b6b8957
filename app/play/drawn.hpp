// SPDX-License-Identifier: AGPL-3.0-or-later
// What is known of the body of a library from the files beside it.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "format/body.hpp"
#include "format/library.hpp"

namespace palpate::app {

struct DrawnBody {
  std::optional<Body> body;         ///< body.h5 beside library.h5 or library.plib
  std::vector<Triangle> triangles;  ///< those of NAME.off beside NAME.plib: the response surface
};

/// @throws Error where a file beside the library cannot be read, or the surface has other vertices.
DrawnBody drawn_body(const std::filesystem::path& file, const Library& library);

}  // namespace palpate::app
