// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/repair.hpp"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "format/error.hpp"
#include "mesher/geometry/cgal_mesh.hpp"
#include "mesher/geometry/queries.hpp"

namespace palpate::mesher {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

using Polygon = std::vector<std::size_t>;
using SoupEdge = std::pair<std::size_t, std::size_t>;

// Points nearer than this fraction of the extent are one point whose copies differ by noise.
constexpr double kNoise = 5e-5;
// Merging must not collapse the mesh: points of edges shorter than this multiple stay apart.
constexpr double kShortestEdge = 4;
// Parts whose area is less than this fraction of the largest are negligible.
constexpr double kNegligibleArea = 0.01;
// A hole whose border leaves its mean plane by less than this fraction of its diameter is a flat
// cut.
constexpr double kFlat = 0.03;
// Alpha and offset of the wrap as fractions of the extent.
constexpr double kWrapAlpha = 1.0 / 50, kWrapOffset = 1.0 / 1500;

/// The faces in the form that CGAL works on.
struct Faces {
  std::vector<Point> points;
  std::vector<Polygon> polygons;
};

Faces to_faces(const Soup& soup) {
  Faces faces;
  for (const Vec3& x : soup.points) faces.points.push_back(to_point(x));
  faces.polygons = soup.polygons;
  return faces;
}

/// Triangles of the faces, each with points of its own: no neighbourhood is assumed.
Surface triangles_of(const Soup& soup) {
  Surface surface;
  for (const Polygon& corners : soup.polygons)
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const auto first = static_cast<std::int32_t>(surface.points.size());
      for (const std::size_t v : {corners[0], corners[k - 1], corners[k]})
        surface.points.push_back(soup.points[v]);
      surface.triangles.push_back({first, first + 1, first + 2});
    }
  return surface;
}

/// Number of polygons at each undirected edge.
std::map<SoupEdge, int> edge_counts(const Faces& faces) {
  std::map<SoupEdge, int> count;
  for (const Polygon& corners : faces.polygons)
    for (std::size_t k = 0; k < corners.size(); ++k)
      ++count[std::minmax(corners[k], corners[(k + 1) % corners.size()])];
  return count;
}

std::vector<std::size_t> border_points(const std::map<SoupEdge, int>& edges) {
  std::vector<std::size_t> points;
  for (const auto& [edge, count] : edges)
    if (count == 1) points.insert(points.end(), {edge.first, edge.second});
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

double shortest_edge(const Faces& faces, const std::map<SoupEdge, int>& edges) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [edge, count] : edges) {
    const double squared =
        CGAL::squared_distance(faces.points[edge.first], faces.points[edge.second]);
    if (squared > 0) shortest = std::min(shortest, std::sqrt(squared));
  }
  return shortest;
}

/// Pairs (point, other point with a smaller number) of `candidates` nearer than `apart`.
std::map<std::size_t, std::size_t> near_pairs(const Faces& faces,
                                              std::vector<std::size_t> candidates, double apart) {
  std::sort(candidates.begin(), candidates.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(faces.points[a].x(), a) < std::pair(faces.points[b].x(), b);
  });
  std::map<std::size_t, std::size_t> target;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Point& x = faces.points[candidates[i]];
    if (target.contains(candidates[i])) continue;
    for (std::size_t k = i + 1; k < candidates.size(); ++k) {
      const Point& y = faces.points[candidates[k]];
      if (y.x() - x.x() > apart) break;
      if (CGAL::squared_distance(x, y) <= apart * apart)
        target.emplace(candidates[k], candidates[i]);
    }
  }
  return target;
}

using PartOfFace = Mesh::Property_map<Mesh::Face_index, std::size_t>;

/// A hole of a mesh, as its border shows it.
struct Hole {
  Vec3 centre{};
  double diameter = 0;  ///< m, diagonal of the bounding box of the border
  double flatness = 0;  ///< m, largest distance of the border from its mean plane
};

Hole hole_at(const Mesh& mesh, Mesh::Halfedge_index border) {
  std::vector<Vec3> points;
  for (const auto h : CGAL::halfedges_around_face(border, mesh))
    points.push_back(to_vec3(mesh.point(mesh.target(h))));
  const Bounds box = bounds(points);
  Hole hole;
  hole.diameter = norm(box.high - box.low);
  for (const Vec3& x : points) hole.centre = hole.centre + x;
  hole.centre = (1.0 / static_cast<double>(points.size())) * hole.centre;
  Vec3 normal{};
  for (std::size_t k = 0; k < points.size(); ++k)
    normal = normal + cross(points[k] - hole.centre, points[(k + 1) % points.size()] - hole.centre);
  if (norm(normal) == 0) return hole;
  normal = unit(normal);
  for (const Vec3& x : points)
    hole.flatness = std::max(hole.flatness, std::abs(dot(x - hole.centre, normal)));
  return hole;
}

class Repair {
 public:
  Repair(const Soup& soup, const RepairSettings& settings, const std::string& where,
         RepairReport& report)
      : original_(triangles_of(soup)),
        soup_(soup),
        settings_(settings),
        where_(where),
        report_(report),
        extent_(largest_dimension(soup.points)) {}

  Surface run() {
    report_.area_before = area(original_);
    Surface surface = settings_.mode == RepairMode::Wrap ? wrapped() : repaired();
    report_.area_after = area(surface);
    report_.volume = signed_volume(surface);
    measure(surface);
    hand_on_names(surface);
    return surface;
  }

 private:
  void did(const std::string& step) { report_.steps.push_back(step); }

  /// All steps in one line.
  std::string steps() const {
    std::string line;
    for (const std::string& step : report_.steps) line += (line.empty() ? "" : ", ") + step;
    return line;
  }

  Surface wrapped() {
    did(text("replaced the surface by its alpha wrap, alpha ", millimetres(kWrapAlpha * extent_)));
    return alpha_wrap(soup_, kWrapAlpha * extent_, kWrapOffset * extent_);
  }

  Surface repaired() {
    Mesh mesh = connect(clean(to_faces(soup_)));
    remove_parts(mesh);
    fill_holes(mesh);
    remove_degenerate(mesh);
    remove_intersections(mesh);
    check(mesh);
    if (!pmp::is_outward_oriented(mesh)) {
      pmp::reverse_face_orientations(mesh);
      did("reversed all faces: they pointed inward");
    }
    mesh.collect_garbage();
    return to_surface(mesh);
  }

  Faces clean(Faces faces) {
    merge_near_points(faces);
    const std::size_t before = faces.polygons.size();
    pmp::repair_polygon_soup(faces.points, faces.polygons);
    if (faces.polygons.size() < before)
      did("removed " + counted(before - faces.polygons.size(), "duplicate or collapsed face"));
    split_t_junctions(faces);
    return faces;
  }

  void merge_near_points(Faces& faces) {
    const auto edges = edge_counts(faces);
    const double apart = std::min(kNoise * extent_, shortest_edge(faces, edges) / kShortestEdge);
    const auto target = near_pairs(faces, border_points(edges), apart);
    for (Polygon& corners : faces.polygons)
      for (std::size_t& v : corners)
        if (const auto found = target.find(v); found != target.end()) v = found->second;
    if (!target.empty())
      did(text("merged ", counted(target.size(), "point"), " less than ", millimetres(apart),
               " apart"));
  }

  /// A border point in the interior of a border edge becomes a corner of the face at that edge.
  void split_t_junctions(Faces& faces) {
    const auto edges = edge_counts(faces);
    const std::vector<std::size_t> border = border_points(edges);
    std::size_t split = 0;
    for (Polygon& corners : faces.polygons) {
      Polygon result;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const std::size_t a = corners[k], b = corners[(k + 1) % corners.size()];
        result.push_back(a);
        if (edges.at(std::minmax(a, b)) != 1) continue;
        const std::vector<std::size_t> inside = points_on(faces, border, a, b);
        result.insert(result.end(), inside.begin(), inside.end());
        split += inside.size();
      }
      corners = std::move(result);
    }
    if (split > 0) did("split " + counted(split, "T-junction"));
  }

  /// Points of `border` in the interior of the edge from a to b, in this order.
  std::vector<std::size_t> points_on(const Faces& faces, const std::vector<std::size_t>& border,
                                     std::size_t a, std::size_t b) const {
    const Point &p = faces.points[a], &q = faces.points[b];
    const Kernel::Vector_3 d = q - p;
    const double length2 = d.squared_length();
    if (length2 == 0) return {};
    std::vector<std::pair<double, std::size_t>> found;
    for (const std::size_t v : border) {
      if (v == a || v == b) continue;
      const Kernel::Vector_3 r = faces.points[v] - p;
      const double t = (r * d) / length2;
      if (t <= 1e-6 || t >= 1 - 1e-6) continue;
      if ((r - t * d).squared_length() <= kNoise * kNoise * extent_ * extent_)
        found.emplace_back(t, v);
    }
    std::sort(found.begin(), found.end());
    std::vector<std::size_t> result;
    for (const auto& [t, v] : found) result.push_back(v);
    return result;
  }

  /// Oriented faces, borders stitched; sheets that met in an edge or a point are separate.
  Mesh connect(Faces faces) {
    const std::size_t points = faces.points.size();
    pmp::orient_polygon_soup(faces.points, faces.polygons);
    if (faces.points.size() > points)
      did(text("separated sheets that met in an edge or a point: ",
               counted(faces.points.size() - points, "point"), " duplicated"));
    Mesh mesh;
    pmp::polygon_soup_to_polygon_mesh(faces.points, faces.polygons, mesh);
    pmp::triangulate_faces(mesh);
    if (const std::size_t stitched = pmp::stitch_borders(mesh); stitched > 0)
      did("stitched " + counted(stitched, "pair") + " of border edges");
    return mesh;
  }

  struct Part {
    std::size_t number = 0;
    CGAL::Bbox_3 box;
    double area = 0;  ///< m^2
    double size() const {
      return std::max({box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin()});
    }
  };

  /// The connected parts of the mesh, the largest area first.
  static std::vector<Part> parts_of(const Mesh& mesh, const PartOfFace& part, std::size_t count) {
    std::vector<Part> parts(count);
    for (std::size_t i = 0; i < count; ++i) parts[i].number = i;
    for (const auto f : mesh.faces()) {
      for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
        parts[part[f]].box += mesh.point(v).bbox();
      parts[part[f]].area += CGAL::to_double(pmp::face_area(f, mesh));
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.area > b.area; });
    return parts;
  }

  void remove_parts(Mesh& mesh) {
    PartOfFace part = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:part", 0).first;
    const std::vector<Part> parts = parts_of(mesh, part, pmp::connected_components(mesh, part));
    std::vector<std::size_t> removed;
    std::vector<Part> remaining;
    for (const Part& p : parts) {
      const bool negligible = p.size() < settings_.negligible_part * extent_ ||
                              p.area < kNegligibleArea * parts.front().area;
      if (!remaining.empty() && (negligible || settings_.largest_part)) {
        removed.push_back(p.number);
        removed_parts_.push_back(p.box);
      } else {
        remaining.push_back(p);
      }
    }
    if (remaining.size() > 1) refuse_parts(remaining);
    if (!removed.empty()) {
      pmp::remove_connected_components(mesh, removed, part);
      did(text("removed ", counted(removed.size(), "separate part"), ", the largest of ",
               millimetres(largest_removed())));
    }
    mesh.remove_property_map(part);
  }

  double largest_removed() const {
    double largest = 0;
    for (const CGAL::Bbox_3& box : removed_parts_)
      largest = std::max(largest, Part{0, box, 0}.size());
    return largest;
  }

  [[noreturn]] void refuse_parts(const std::vector<Part>& parts) const {
    constexpr std::size_t kListed = 3;
    std::string list;
    for (std::size_t i = 0; i < std::min(parts.size(), kListed); ++i) {
      const CGAL::Bbox_3& b = parts[i].box;
      list += text(i > 0 ? "; " : "", millimetres(Vec3{b.xmin(), b.ymin(), b.zmin()}), " to ",
                   millimetres(Vec3{b.xmax(), b.ymax(), b.zmax()}));
    }
    refuse_geometry(
        where_,
        text("the surface has ", parts.size(), " separate parts, the largest first: ", list,
             parts.size() > kListed ? "; ..." : ""),
        "set surface.parts = \"largest\" or surface.repair = \"wrap\", or keep one part for each "
        "file and give inner parts as inclusions");
  }

  void fill_holes(Mesh& mesh) {
    std::vector<Mesh::Halfedge_index> cycles;
    pmp::extract_boundary_cycles(mesh, std::back_inserter(cycles));
    std::size_t filled = 0;
    double largest = 0;
    for (const auto h : cycles) {
      const Hole hole = hole_at(mesh, h);
      const bool flat = hole.flatness <= kFlat * hole.diameter;
      if (hole.diameter > settings_.max_hole * extent_ && !flat)
        refuse_geometry(
            where_,
            text("the surface is not watertight: a hole of ", millimetres(hole.diameter), " at ",
                 millimetres(hole.centre)),
            "close it in a mesh editor, raise surface.max_hole, or set surface.repair = "
            "\"wrap\"");
      fill_hole(mesh, h, hole);
      ++filled;
      largest = std::max(largest, hole.diameter);
    }
    if (filled > 0)
      did(text("filled ", counted(filled, "hole"), ", the largest of ", millimetres(largest)));
  }

  void fill_hole(Mesh& mesh, Mesh::Halfedge_index border, const Hole& hole) const {
    std::vector<Mesh::Face_index> faces;
    std::vector<Mesh::Vertex_index> vertices;
    pmp::triangulate_and_refine_hole(mesh, border, std::back_inserter(faces),
                                     std::back_inserter(vertices));
    if (faces.empty())
      refuse_geometry(where_,
                      text("the hole of ", millimetres(hole.diameter), " at ",
                           millimetres(hole.centre), " cannot be filled"),
                      "close it in a mesh editor or set surface.repair = \"wrap\"");
  }

  void remove_degenerate(Mesh& mesh) {
    const std::size_t before = mesh.number_of_faces();
    pmp::remove_degenerate_faces(mesh);
    if (mesh.number_of_faces() != before) did("removed faces of zero area");
  }

  void remove_intersections(Mesh& mesh) {
    if (!pmp::does_self_intersect(mesh)) return;
    std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
    pmp::self_intersections(mesh, std::back_inserter(pairs));
    pmp::experimental::remove_self_intersections(mesh, pmp::parameters::preserve_genus(false));
    if (!pmp::does_self_intersect(mesh))
      did("removed " + counted(pairs.size(), "self-intersection") + " of faces");
  }

  void check(const Mesh& mesh) const {
    if (mesh.is_empty() || mesh.number_of_faces() == 0)
      refuse_geometry(where_, "the faces do not bound a volume",
                      "export the surface as one closed, triangulated surface");
    std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
    pmp::self_intersections(mesh, std::back_inserter(pairs));
    if (!pairs.empty()) {
      const auto v = mesh.target(mesh.halfedge(pairs.front().first));
      refuse_geometry(where_,
                      text("the surface self-intersects: ", counted(pairs.size(), "pair"),
                           " of triangles, the first near ", millimetres(to_vec3(mesh.point(v)))),
                      "resolve the self-intersections in a mesh editor or set surface.repair = "
                      "\"wrap\"");
    }
    if (!CGAL::is_closed(mesh))
      refuse_geometry(where_, "the surface is not watertight after the repair",
                      "close its holes in a mesh editor or set surface.repair = \"wrap\"");
  }

  /// Distances at the corners and the middles of the triangles, both ways.
  void measure(const Surface& surface) {
    const SurfaceQuery after(surface), before(original_);
    const auto largest = [](const Surface& from, const SurfaceQuery& to, double& distance,
                            Vec3& at) {
      const auto look = [&](const Vec3& x) {
        const double d = norm(to.closest(x).point - x);
        if (d <= distance) return;
        distance = d;
        at = x;
      };
      for (const Triangle& t : from.triangles) {
        Vec3 sum{};
        for (const auto v : t) sum = sum + from.points[static_cast<std::size_t>(v)];
        look((1.0 / 3) * sum);
      }
      for (const Vec3& x : from.points) look(x);
    };
    largest(remaining_original(), after, report_.moved, report_.moved_at);
    largest(surface, before, report_.added, report_.added_at);
    if (settings_.mode == RepairMode::Wrap || report_.moved <= settings_.max_change * extent_)
      return;
    refuse_geometry(where_,
                    text("the repair (", steps(), ") would move the surface by ",
                         millimetres(report_.moved), " at ", millimetres(report_.moved_at),
                         ", more than max_change = ", settings_.max_change, " of its extent"),
                    "raise surface.max_change, or mend the surface there in a mesh editor");
  }

  /// The triangles of the original outside the parts that were removed on purpose.
  Surface remaining_original() const {
    Surface remaining;
    for (const Triangle& t : original_.triangles) {
      const bool removed =
          std::any_of(removed_parts_.begin(), removed_parts_.end(), [&](const CGAL::Bbox_3& box) {
            return std::all_of(t.begin(), t.end(), [&](std::int32_t v) {
              const Point x = to_point(original_.points[static_cast<std::size_t>(v)]);
              return CGAL::do_overlap(box, x.bbox());
            });
          });
      if (removed) continue;
      const auto first = static_cast<std::int32_t>(remaining.points.size());
      for (const std::int32_t v : t)
        remaining.points.push_back(original_.points[static_cast<std::size_t>(v)]);
      remaining.triangles.push_back({first, first + 1, first + 2});
    }
    return remaining;
  }

  /// Each triangle bears the names of the nearest face of the file.
  void hand_on_names(Surface& surface) const {
    if (soup_.names.empty()) return;
    std::vector<std::size_t> polygon_of_triangle;
    for (std::size_t p = 0; p < soup_.polygons.size(); ++p)
      polygon_of_triangle.insert(polygon_of_triangle.end(), soup_.polygons[p].size() - 2, p);
    const SurfaceQuery before(original_);
    surface.known_names = soup_.known_names;
    for (const Triangle& t : surface.triangles) {
      Vec3 sum{};
      for (const auto v : t) sum = sum + surface.points[static_cast<std::size_t>(v)];
      const auto nearest = static_cast<std::size_t>(before.closest((1.0 / 3) * sum).triangle);
      surface.names.push_back(soup_.names[polygon_of_triangle[nearest]]);
    }
  }

  Surface original_;
  const Soup& soup_;
  const RepairSettings& settings_;
  const std::string& where_;
  RepairReport& report_;
  double extent_;
  std::vector<CGAL::Bbox_3> removed_parts_;
};

}  // namespace

bool is_sound(const Soup& soup) {
  Faces faces = to_faces(soup);
  if (!pmp::orient_polygon_soup(faces.points, faces.polygons)) return false;
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces.polygons)) return false;
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(faces.points, faces.polygons, mesh);
  if (!pmp::triangulate_faces(mesh) || !CGAL::is_closed(mesh)) return false;
  auto part = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:part", 0).first;
  if (pmp::connected_components(mesh, part) != 1) return false;
  const bool degenerate = std::any_of(mesh.faces().begin(), mesh.faces().end(), [&](auto f) {
    return pmp::is_degenerate_triangle_face(f, mesh);
  });
  return !degenerate && !pmp::does_self_intersect(mesh);
}

Surface repair(const Soup& soup, const RepairSettings& settings, const std::string& where,
               RepairReport& report) {
  return Repair(soup, settings, where, report).run();
}

}  // namespace palpate::mesher
