// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/check_surface.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string_view>
#include <utility>

#include "format/position_text.hpp"
#include "mesher/read/read_surface.hpp"
#include "mesher/repair/diagnosis.hpp"

namespace palpate::app {
namespace {

void examine(SurfaceCheck& check, mesher::Soup soup, const mesher::SurfaceFile& file) {
  const std::string where = file.path.string();
  for (Vec3& x : soup.points) x = file.unit * x;
  mesher::tidy(soup, where, {});
  mesher::check_entries(soup, where);
  mesher::Diagnosis found = mesher::diagnose(soup, where);
  check.faults = std::move(found.findings);
  check.faulty = std::move(found.faces);
  for (Vec3& x : check.faulty.points) x = (1 / file.unit) * x;
}

/// The line of the log without the path in front of its text.
std::string without_path(std::string_view line, const std::string& path) {
  std::string text(line);
  if (const auto at = text.find(path + ": "); at != std::string::npos)
    text.erase(at, path.size() + 2);
  return text;
}

}  // namespace

SurfaceCheck check_surface(const std::filesystem::path& path, const std::string& unit,
                           bool largest_part) {
  SurfaceCheck check;
  check.file.path = path;
  mesher::Soup listed = mesher::read_faces(path);
  check.points = listed.points.size();
  check.faces = listed.polygons.size();
  check.raw_size = mesher::largest_dimension(listed.points);
  find_unit(check.file, unit, check.raw_size);
  print_positions_in(check.file.unit);
  mesher::SurfaceFile file{path, check.file.unit.si, ""};
  file.repair.largest_part = largest_part;
  try {
    examine(check, std::move(listed), file);
    check.file.surface = mesher::read_surface(file, [&](std::string_view line) {
      check.repairs.push_back(without_path(line, path.string()));
    });
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::Geometry) throw;
    check.refusal = error;
  }
  return check;
}

std::string ply_text(const mesher::Surface& surface, double unit) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
                 "property double z\nelement face {}\nproperty list uchar int vertex_indices\n"
                 "end_header\n",
                 surface.points.size(), surface.triangles.size());
  for (const Vec3& x : surface.points)
    fmt::format_to(out, "{} {} {}\n", x[0] / unit, x[1] / unit, x[2] / unit);
  for (const Triangle& t : surface.triangles) fmt::format_to(out, "3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

}  // namespace palpate::app
