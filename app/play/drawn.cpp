// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/play/drawn.hpp"

#include "format/error.hpp"
#include "format/flat_library.hpp"
#include "mesher/read/read_off.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

constexpr double kSame = 1e-9;  // m, between a vertex of the file and that of the library

std::vector<Triangle> triangles_of(const fs::path& file, const Library& library) {
  const mesher::Soup soup = mesher::read_off(content_of(file), file.string());
  bool same = soup.points.size() == library.positions.size();
  for (std::size_t v = 0; same && v < soup.points.size(); ++v)
    same = norm(soup.points[v] - library.positions[v]) <= kSame;
  if (!same)
    refuse(file.string(), "its vertices are not those of the library beside it",
           "write it anew with `palpate export surface`");
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

}  // namespace

DrawnBody drawn_body(const fs::path& file, const Library& library) {
  DrawnBody drawn;
  const fs::path body = file.parent_path() / "body.h5";
  const fs::path surface = fs::path(file).replace_extension(".off");
  if (file.stem() == "library" && fs::exists(body))
    drawn.body = read_body(body);
  else if (fs::exists(surface))
    drawn.triangles = triangles_of(surface, library);
  return drawn;
}

}  // namespace palpate::app
