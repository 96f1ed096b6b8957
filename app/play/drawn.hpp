// SPDX-License-Identifier: AGPL-3.0-or-later
// What is known of the body of a library from the files beside it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/report/play_page.hpp"
#include "format/body.hpp"
#include "format/library.hpp"

namespace palpate::app {

struct DrawnBody {
  std::optional<Body> body;         ///< body.h5 beside library.h5 or library.plib
  std::vector<Triangle> triangles;  ///< those of NAME.off beside NAME.plib: the response surface
  std::vector<report::InnerSurface> inclusions;  ///< NAME.REGION.off beside NAME.off, by region
  std::string deformation;  ///< bytes of deformation.pdef beside library.h5, or of NAME.pdef

  report::PlayBody to_draw() const {
    return {body ? &*body : nullptr, triangles, inclusions, deformation};
  }
};

/// @throws Error where a file beside the library cannot be read, or the surface has other vertices.
DrawnBody drawn_body(const std::filesystem::path& file, const Library& library);

}  // namespace palpate::app
