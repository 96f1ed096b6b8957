// SPDX-License-Identifier: AGPL-3.0-or-later
// The page to touch of a library, without the curves that it was made from.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "format/body.hpp"
#include "format/library.hpp"

namespace palpate::report {

/// The closed surface of a region inside the body, oriented outwards.
struct InnerSurface {
  std::string region;
  std::vector<Vec3> points;  ///< m
  std::vector<Triangle> facets;
};

/// What is known of the body beside its library, to be drawn; all of it may be missing.
struct PlayBody {
  const Body* body = nullptr;  ///< that of the library: its boundary, inclusions and supports
  std::vector<Triangle>
      triangles{};  ///< the whole response surface, with the vertices of the library
  std::vector<InnerSurface> inclusions{};  ///< where there is no body
  std::string_view deformation{};          ///< bytes of the deformation file
};

/// Data of the page, in SI units. Without a body the triangles are drawn, and without these those
/// of the library, which are the part that can be pressed. The depth is that of the certificate, or
/// else the smallest that every response was computed to.
/// @throws Error(Configuration) where no vertex has a response, or the body is another one.
nlohmann::json play_data(const Library& library, const PlayBody& drawn = {});

/// One self-contained HTML file, as that of write_report.
/// @throws Error as play_data, Error(Configuration) where this program was built without the
///   WebAssembly toolchain, Error(Internal) when the file cannot be written.
void write_play_page(const Library& library, const PlayBody& drawn,
                     const std::filesystem::path& path);

/// Data of the page of a running session: those of play_data, marked as such.
nlohmann::json watch_data(const Library& library, const PlayBody& drawn = {});

/// The page of a running session, which its server gives: it takes the steps from "/steps" of its
/// origin.
/// @throws Error as play_data.
std::string watch_page(const Library& library, const PlayBody& drawn = {});

}  // namespace palpate::report
