// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/read_surface.hpp"

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>

#include <array>
#include <filesystem>
#include <string>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/cgal_guard.hpp"
#include "mesher/geometry/cgal_mesh.hpp"
#include "mesher/geometry/faulty_faces.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/geometry/soup.hpp"
#include "mesher/read/body_size.hpp"
#include "mesher/read/file/file.hpp"
#include "mesher/read/read_obj.hpp"
#include "mesher/read/read_off.hpp"
#include "mesher/read/read_ply.hpp"
#include "mesher/read/read_stl.hpp"
#include "mesher/read/vtk/read_vtk_legacy.hpp"
#include "mesher/read/vtk/read_vtk_xml.hpp"
#include "mesher/repair/repair.hpp"
#include "mesher/repair/soundness.hpp"

namespace palpate::mesher {
namespace {

namespace fs = std::filesystem;
namespace pmp = CGAL::Polygon_mesh_processing;

Soup read_binary_stl(const std::string& where) {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  if (!CGAL::IO::read_polygon_soup(where, points, polygons, CGAL::parameters::verbose(false))) {
    refuse_geometry(where,
                    points.empty() && polygons.empty()
                        ? "the file is empty or cannot be read as its ending says"
                        : text("the file is malformed after ", counted(points.size(), "point"),
                               " and ", counted(polygons.size(), "face")),
                    "export the surface again");
  }
  Soup soup;
  soup.polygons = std::move(polygons);
  for (const Point& p : points) soup.points.push_back(to_vec3(p));
  return soup;
}

Soup read_stl(const std::string& bytes, const std::string& where) {
  return is_text_stl(bytes) ? read_text_stl(bytes, where) : read_binary_stl(where);
}

/// A kind of file that holds a surface.
struct SurfaceKind {
  const char* ending;
  const char* name;
  Soup (*read)(const std::filesystem::path& path);
};

constexpr std::array<SurfaceKind, 7> kSurfaceKinds{{
    {".off", "OFF", [](const fs::path& path) { return read_off(read_bytes(path), path.string()); }},
    {".obj", "OBJ", [](const fs::path& path) { return read_obj(path); }},
    {".ply", "PLY", [](const fs::path& path) { return read_ply(read_bytes(path), path.string()); }},
    {".stl", "STL", [](const fs::path& path) { return read_stl(read_bytes(path), path.string()); }},
    {".vtp", "VTK XML",
     [](const fs::path& path) {
       return surface_of(read_vtk_xml(read_bytes(path), path.string()), path.string());
     }},
    {".vtu", "VTK XML",
     [](const fs::path& path) {
       return surface_of(read_vtk_xml(read_bytes(path), path.string()), path.string());
     }},
    {".vtk", "VTK legacy",
     [](const fs::path& path) {
       return surface_of(read_vtk_legacy(read_bytes(path), path.string()), path.string());
     }},
}};

/// "OFF (.off), OBJ (.obj) or VTK legacy (.vtk)".
std::string known_kinds() {
  std::string kinds;
  for (const SurfaceKind& kind : kSurfaceKinds) {
    if (!kinds.empty()) kinds += &kind == &kSurfaceKinds.back() ? " or " : ", ";
    kinds += text(kind.name, " (", kind.ending, ")");
  }
  return kinds;
}

Soup read_listed(const std::filesystem::path& path) {
  check_readable(path);
  const std::string wanted = ending(path);
  for (const SurfaceKind& kind : kSurfaceKinds)
    if (wanted == kind.ending) return kind.read(path);
  refuse_kind(path, "surface file", known_kinds());
}

void scale_to_metres(Soup& soup, const SurfaceFile& file, const Log& log) {
  check_body_size(largest_dimension(soup.points), file.unit, file.path.string(), log);
  for (Vec3& x : soup.points) x = file.unit * x;
}

/// Copies the names of a polygon to the triangles it is split into.
struct NamesOfParts : pmp::Triangulate_faces::Default_visitor<Mesh> {
  explicit NamesOfParts(std::vector<std::size_t>& n) : names(&n) {}
  void before_subface_creations(Mesh::Face_index face) { whole = (*names)[face.idx()]; }
  void after_subface_created(Mesh::Face_index face) {
    if (face.idx() >= names->size()) names->resize(face.idx() + 1);
    (*names)[face.idx()] = whole;
  }
  std::vector<std::size_t>* names;
  std::size_t whole = 0;
};

/// @pre the soup is manifold, closed and oriented.
Surface triangulate(const Soup& soup, const std::string& where) {
  std::vector<Point> points;
  for (const Vec3& x : soup.points) points.push_back(to_point(x));
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, soup.polygons, mesh);
  std::vector<std::size_t> names = soup.names;
  names.resize(soup.polygons.size());
  if (!pmp::triangulate_faces(mesh, pmp::parameters::visitor(NamesOfParts(names)))) {
    refuse_geometry(where, "a face with more than three corners cannot be split into triangles",
                    "triangulate the surface in a mesh editor");
  }
  mesh.collect_garbage();  // there is none: faces are split, not removed
  Surface surface = to_surface(mesh);
  if (!soup.names.empty()) surface.names = std::move(names);
  surface.known_names = soup.known_names;
  return surface;
}

void check_geometry(const Surface& surface, const std::string& where) {
  FaultyFaces faulty;
  const auto add = [&](std::int32_t t, Fault fault) {
    faulty.add(surface, surface.triangles[to_index(t)], fault);
  };
  if (const auto flat = degenerate_triangles(surface); !flat.empty()) {
    for (const std::int32_t t : flat) add(t, Fault::ZeroArea);
    throw FaultySurface(where,
                        text(counted(flat.size(), "triangle"), " of zero area, the first at ",
                             position_text(faulty.points.front())),
                        "remove degenerate faces in a mesh editor", faulty);
  }
  if (const auto pairs = self_intersections(surface); !pairs.empty()) {
    for (const auto& [a, b] : pairs) {
      add(a, Fault::SelfIntersection);
      add(b, Fault::SelfIntersection);
    }
    throw FaultySurface(where,
                        text("the surface self-intersects: ", counted(pairs.size(), "pair"),
                             " of triangles, the first at ", position_text(faulty.points.front())),
                        "resolve the self-intersections in a mesh editor", faulty);
  }
}

void turn_outward(Surface& surface, const std::string& where, const Log& log) {
  if (signed_volume(surface) >= 0) return;
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  note(log, where + ": the faces were oriented inward; all were reversed");
}

/// The surface as the file has it, or a refusal that names its fault.
Surface checked(Soup soup, const std::string& where, const Log& log) {
  check_manifold(soup, where);
  orient(soup, where, log);
  Surface surface = triangulate(soup, where);
  check_geometry(surface, where);
  return surface;
}

Surface repaired(const Soup& soup, const RepairSettings& settings, const std::string& where,
                 const Log& log, const OnRepair& on_repair) {
  RepairReport report;
  Surface surface;
  guard_cgal(where, "mend the surface in a mesh editor",
             [&] { surface = repair(soup, settings, where, report); });
  for (const std::string& step : report.steps) note(log, text(where, ": ", step));
  for (const std::string& warning : report.warnings) warn(log, text(where, ": ", warning));
  note(log, text(where, ": repaired: area ", 1e6 * report.area_before, " to ",
                 1e6 * report.area_after, " mm^2, volume ", 1e9 * report.volume,
                 " mm^3; the surface moved by at most ", millimetres(report.moved), " at ",
                 position_text(report.moved_at), "; what was added is at most ",
                 millimetres(report.added), " from it, at ", position_text(report.added_at)));
  if (on_repair) on_repair(report.kept, surface);
  return surface;
}

Surface sound_surface(const SurfaceFile& file, const Log& log, const OnRepair& on_repair) {
  const std::string where = file.path.string();
  Soup soup = read_faces(file.path);
  scale_to_metres(soup, file, log);
  tidy(soup, where, log);
  check_entries(soup, where);
  const bool repairs = file.repair.mode == RepairMode::Wrap ||
                       (file.repair.mode == RepairMode::Auto && !is_sound(soup));
  Surface surface = repairs ? repaired(soup, file.repair, where, log, on_repair)
                            : checked(std::move(soup), where, log);
  turn_outward(surface, where, log);
  const Bounds box = bounds(surface.points);
  note(log,
       text(where, ": ", surface.points.size(), " points, ", surface.triangles.size(),
            " triangles, watertight, ", position_text(box.low), " to ", position_text(box.high)));
  return surface;
}

}  // namespace

Soup read_faces(const std::filesystem::path& path) {
  Soup soup = read_listed(path);
  check_entries(soup, path.string());
  return soup;
}

Surface read_surface(const SurfaceFile& file, const Log& log, const OnRepair& on_repair) {
  try {
    return sound_surface(file, log, on_repair);
  } catch (const FaultySurface& fault) {
    FaultyFaces faces = fault.faces();
    for (Vec3& x : faces.points) x = (1 / file.unit) * x;
    throw FaultySurface(fault.where(), fault.problem(), fault.remedy(), std::move(faces));
  }
}

}  // namespace palpate::mesher
