// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/crossings.hpp"

#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include "mesher/geometry/cgal_mesh.hpp"
#include "mesher/geometry/queries.hpp"

namespace palpate::mesher {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

// Above this number of pairs, and this fraction of the faces, the crossings are not local.
constexpr std::size_t kFew = 200;
constexpr double kLocal = 0.02;

}  // namespace

void remove_degenerate_faces(Surface& surface, Steps& steps) {
  if (count_degenerate_triangles(surface) == 0) return;
  Mesh mesh = to_mesh(surface);
  pmp::remove_degenerate_faces(mesh);
  mesh.collect_garbage();
  surface = to_surface(mesh);
  steps.push_back("removed faces of zero area");
}

bool remove_crossings(Surface& surface, Steps& steps) {
  const std::size_t count = count_self_intersections(surface);
  if (count == 0) return true;
  if (count > kFew &&
      static_cast<double>(count) > kLocal * static_cast<double>(surface.triangles.size()))
    return false;
  Mesh mesh = to_mesh(surface);
  pmp::experimental::remove_self_intersections(mesh, pmp::parameters::preserve_genus(false));
  if (pmp::does_self_intersect(mesh)) return false;
  mesh.collect_garbage();
  surface = to_surface(mesh);
  steps.push_back("removed " + counted(count, "self-intersection") + " of faces");
  return true;
}

}  // namespace palpate::mesher
