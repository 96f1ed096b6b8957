// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/play/drawn.hpp"

#include <algorithm>
#include <utility>

#include "fitting/response/response_surface.hpp"
#include "format/error.hpp"
#include "format/flat_library.hpp"
#include "mesher/read/read_off.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

constexpr double kSame = 1e-9;  // m, between a vertex of the file and the library, beside its grid

std::vector<Triangle> triangles_of(const mesher::Soup& soup, const fs::path& file) {
  std::vector<Triangle> triangles;
  for (const auto& polygon : soup.polygons) {
    if (polygon.size() != 3)
      refuse(file.string(), "it has other faces than triangles",
             "write it anew with `palpate export surface`");
    Triangle& t = triangles.emplace_back();
    for (std::size_t l = 0; l < 3; ++l) t[l] = static_cast<std::int32_t>(polygon[l]);
  }
  return triangles;
}

std::vector<Triangle> response_triangles(const fs::path& file, const Library& library) {
  const mesher::Soup soup = mesher::read_off(content_of(file), file.string());
  const double tolerance = kSame + fitting::grid_of(soup.points);
  bool same = soup.points.size() == library.positions.size();
  for (std::size_t v = 0; same && v < soup.points.size(); ++v)
    same = norm(soup.points[v] - library.positions[v]) <= tolerance;
  if (!same)
    refuse(file.string(), "its vertices are not those of the library beside it",
           "write it anew with `palpate export surface`");
  return triangles_of(soup, file);
}

/// The files NAME.REGION.off, in the order of their regions.
std::vector<report::InnerSurface> inner_surfaces(const fs::path& surface) {
  const std::string begins = surface.stem().string() + ".";
  std::vector<report::InnerSurface> found;
  const fs::path folder = surface.has_parent_path() ? surface.parent_path() : fs::path(".");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& file = entry.path();
    const std::string stem = file.stem().string();
    if (file.extension() != ".off" || !stem.starts_with(begins)) continue;
    mesher::Soup soup = mesher::read_off(content_of(file), file.string());
    std::vector<Triangle> facets = triangles_of(soup, file);
    found.push_back({stem.substr(begins.size()), std::move(soup.points), std::move(facets)});
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.region < b.region; });
  return found;
}

}  // namespace

DrawnBody drawn_body(const fs::path& file, const Library& library) {
  DrawnBody drawn;
  const bool of_case = file.stem() == "library";
  const fs::path body = file.parent_path() / "body.h5";
  const fs::path surface = fs::path(file).replace_extension(".off");
  const fs::path deformation =
      of_case ? file.parent_path() / "deformation.pdef" : fs::path(file).replace_extension(".pdef");
  if (of_case && fs::exists(body)) {
    drawn.body = read_body(body);
  } else if (fs::exists(surface)) {
    drawn.triangles = response_triangles(surface, library);
    drawn.inclusions = inner_surfaces(surface);
  }
  if (fs::exists(deformation)) drawn.deformation = content_of(deformation);
  return drawn;
}

}  // namespace palpate::app
