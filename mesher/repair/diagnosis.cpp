// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/diagnosis.hpp"

#include <algorithm>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/geometry/cgal_guard.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/geometry/soup_edges.hpp"
#include "mesher/repair/crossings.hpp"
#include "mesher/repair/holes.hpp"
#include "mesher/repair/parts.hpp"
#include "mesher/repair/sheets.hpp"

namespace palpate::mesher {
namespace {

constexpr std::size_t kListed = 4;

class Examination {
 public:
  explicit Examination(const Soup& soup) : soup_(soup), edges_(polygons_of_edges(soup)) {}

  Diagnosis run() {
    count_edges();
    count_points();
    count_orientations();
    count_duplicates();
    Steps ignored;
    const Surface connected = connect(soup_, ignored).surface;
    list_holes(connected);
    count_flat_and_crossing(connected);
    list_parts(connected);
    check_outward(connected);
    return std::move(found_);
  }

 private:
  template <class... Part>
  void tell(const Part&... parts) {
    found_.findings.push_back(text(parts...));
  }

  void add_faces(const FaultyFaces& faces) {
    FaultyFaces& all = found_.faces;
    all.points.insert(all.points.end(), faces.points.begin(), faces.points.end());
    all.faults.insert(all.faults.end(), faces.faults.begin(), faces.faults.end());
  }

  std::string middle_of(const SoupEdge& edge) const {
    return position_text(0.5 * (soup_.points[edge.first] + soup_.points[edge.second]));
  }

  void count_edges() {
    std::vector<SoupEdge> border, crowded;
    for (const auto& [edge, polygons] : edges_) {
      if (polygons.size() == 1) border.push_back(edge);
      if (polygons.size() > 2) crowded.push_back(edge);
    }
    if (!border.empty())
      tell(counted(border.size(), "border edge"), ", the first at ", middle_of(border.front()));
    if (!crowded.empty())
      tell(counted(crowded.size(), "edge"), " with more than two faces, the first at ",
           middle_of(crowded.front()));
    add_faces(faces_at_edges(soup_, edges_));
  }

  void count_points() {
    const std::vector<std::size_t> pinched = pinched_points(soup_, edges_);
    if (pinched.empty()) return;
    add_faces(faces_at_points(soup_, pinched));
    tell(counted(pinched.size(), "point"), " in which sheets meet, the first at ",
         position_text(soup_.points[pinched.front()]));
  }

  void count_orientations() {
    const std::vector<SoupEdge> edges = discordant_edges(soup_, edges_);
    if (!edges.empty())
      tell(counted(edges.size(), "edge"), " between faces of opposite orientation, the first at ",
           middle_of(edges.front()));
  }

  void count_duplicates() {
    Soup soup{soup_.points, soup_.polygons, {}, {}};
    Steps ignored;
    remove_duplicate_faces(soup, ignored);
    const std::size_t removed = soup_.polygons.size() - soup.polygons.size();
    if (removed > 0) tell(counted(removed, "duplicate or collapsed face"));
  }

  void list_holes(Surface surface) {
    std::vector<Hole> holes = fill_holes(surface);
    if (holes.empty()) return;
    std::stable_sort(holes.begin(), holes.end(),
                     [](const Hole& a, const Hole& b) { return a.diameter > b.diameter; });
    std::string list;
    for (std::size_t i = 0; i < std::min(kListed, holes.size()); ++i)
      list += text(i > 0 ? "; " : "", millimetres(holes[i].diameter), " at ",
                   position_text(holes[i].centre));
    tell(counted(holes.size(), "hole"), ", the largest first: ", list,
         holes.size() > kListed ? "; ..." : "");
  }

  void count_flat_and_crossing(const Surface& connected) {
    const auto first_point = [&](std::int32_t t) {
      return position_text(connected.points[to_index(connected.triangles[to_index(t)][0])]);
    };
    const std::vector<std::int32_t> flat = degenerate_triangles(connected);
    if (!flat.empty())
      tell(counted(flat.size(), "face"), " of zero area, the first at ", first_point(flat[0]));
    for (const std::int32_t t : flat)
      found_.faces.add(connected, connected.triangles[to_index(t)], Fault::ZeroArea);
    count_crossings(connected);
  }

  void count_crossings(Surface surface) {
    Steps ignored;
    remove_degenerate_faces(surface, ignored);  // which no predicate of a crossing takes
    const std::vector<TrianglePair> pairs = self_intersections(surface);
    if (pairs.empty()) return;
    for (const auto& [a, b] : pairs)
      for (const std::int32_t t : {a, b})
        found_.faces.add(surface, surface.triangles[to_index(t)], Fault::SelfIntersection);
    const Triangle& first = surface.triangles[to_index(pairs.front().first)];
    tell(counted(pairs.size(), "pair"), " of faces that cross, the first at ",
         position_text(surface.points[to_index(first[0])]));
  }

  void list_parts(const Surface& connected) {
    const std::vector<std::string> parts = describe_parts(connected);
    if (parts.size() < 2) return;
    std::string list;
    for (std::size_t i = 0; i < std::min(kListed, parts.size()); ++i)
      list += (i > 0 ? "; " : "") + parts[i];
    tell(parts.size(), " separate parts, the largest first: ", list,
         parts.size() > kListed ? "; ..." : "");
  }

  void check_outward(const Surface& connected) {
    if (!found_.findings.empty() || signed_volume(connected) >= 0) return;
    tell("all faces point inward");
  }

  const Soup& soup_;
  PolygonsOfEdges edges_;
  Diagnosis found_;
};

}  // namespace

Diagnosis diagnose(const Soup& soup, const std::string& where) {
  Diagnosis diagnosis;
  guard_cgal(where, "mend the surface in a mesh editor",
             [&] { diagnosis = Examination(soup).run(); });
  return diagnosis;
}

}  // namespace palpate::mesher
