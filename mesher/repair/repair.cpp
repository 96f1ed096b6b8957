// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/cgal_guard.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/repair/change.hpp"
#include "mesher/repair/crossings.hpp"
#include "mesher/repair/holes.hpp"
#include "mesher/repair/parts.hpp"
#include "mesher/repair/points.hpp"
#include "mesher/repair/sheets.hpp"
#include "mesher/repair/soundness.hpp"
#include "mesher/repair/wrap.hpp"

namespace palpate::mesher {
namespace {

// Alphas of the wraps, as fractions of the extent.
constexpr std::array<double, 2> kAlphas = {1.0 / 50, 1.0 / 100};
// A wrap will do where at most this fraction of the area of the file is farther than max_change; of
// the finest wrap, at most the second fraction. A finer one takes four times as long.
constexpr double kFewFar = 0.02, kMostFar = 0.1;
// Local repairs are taken with a warning where they move so little of the area by at most this
// multiple of max_change.
constexpr double kLittleMore = 2;
// Of sheets that met in edges, the largest must have this fraction of the area.
constexpr double kMainSheet = 0.5;
// A surface with a smaller mean thickness, as a fraction of its extent, is a sheet.
constexpr double kSheet = 1e-3;
// A wrap whose mean thickness is a smaller fraction of alpha is a skin about open sheets.
constexpr double kSkin = 0.5;

/// Triangles of the faces, each with points of its own: no neighbourhood is assumed.
Surface triangles_of(const Soup& soup) {
  Surface surface;
  for (const auto& corners : soup.polygons)
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const auto first = static_cast<std::int32_t>(surface.points.size());
      for (const std::size_t v : {corners[0], corners[k - 1], corners[k]})
        surface.points.push_back(soup.points[v]);
      surface.triangles.push_back({first, first + 1, first + 2});
    }
  return surface;
}

Soup to_soup(const Surface& surface) {
  Soup soup;
  soup.points = surface.points;
  for (const Triangle& t : surface.triangles)
    soup.polygons.push_back({to_index(t[0]), to_index(t[1]), to_index(t[2])});
  return soup;
}

FaultyFaces faces_of(const Surface& surface, const std::vector<TrianglePair>& pairs) {
  std::vector<std::int32_t> triangles;
  for (const auto& [a, b] : pairs) triangles.insert(triangles.end(), {a, b});
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  FaultyFaces faulty;
  for (const std::int32_t t : triangles)
    faulty.add(surface, surface.triangles[to_index(t)], Fault::SelfIntersection);
  return faulty;
}

class Repair {
 public:
  Repair(const Soup& soup, const RepairSettings& settings, const std::string& where,
         RepairReport& report)
      : soup_(soup),
        settings_(settings),
        where_(where),
        report_(report),
        original_(triangles_of(soup)),
        kept_(original_),
        filled_(original_),
        extent_(largest_dimension(soup.points)) {}

  Surface run() {
    report_.area_before = area(original_);
    Surface surface = settings_.mode == RepairMode::Wrap ? wrapped_on_request() : repaired();
    report_.area_after = area(surface);
    report_.volume = signed_volume(surface);
    report_.kept = kept_;
    if (!soup_.names.empty()) {
      hand_on_names(surface, original_, names_of_triangles());
      surface.known_names = soup_.known_names;
    }
    return surface;
  }

 private:
  /// Why local repairs do not suffice.
  struct Shortcoming {
    std::string problem;  ///< empty: they do
    FaultyFaces faces;
  };

  double most_moved() const { return settings_.max_change * extent_; }

  Surface repaired() {
    Surface surface;
    Shortcoming left;
    try {
      guard_cgal(where_, {}, [&] { left = mend(surface); });
    } catch (const FaultySurface&) {
      throw;
    } catch (const Error& error) {
      left.problem = error.problem();
    }
    return left.problem.empty() ? surface : wrapped_instead(left);
  }

  Surface wrapped_on_request() {
    try {
      guard_cgal(where_, {}, [&] {
        filled_ = connected().surface;
        fill();
      });
    } catch (const Error& error) {
      report_.warnings.push_back(error.problem() + "; holes are bridged, not filled");
    }
    const double alpha = kAlphas.front() * extent_;
    Surface wrap = alpha_wrap(filled_, alpha, alpha / kAlphaPerOffset);
    report_.steps.push_back(
        text("replaced the surface by its alpha wrap, alpha ", millimetres(alpha)));
    measure(wrap);
    return wrap;
  }

  Sheets connected() {
    Soup soup{soup_.points, soup_.polygons, {}, {}};
    merge_near_points(soup, extent_, report_.steps);
    remove_duplicate_faces(soup, report_.steps);
    split_t_junctions(soup, extent_, report_.steps);
    return connect(soup, report_.steps);
  }

  /// Local repairs.
  Shortcoming mend(Surface& surface) {
    Sheets sheets = connected();
    if (sheets.separated && largest_fraction(sheets.surface) < kMainSheet)
      return {"the faces share edges and do not separate into one main sheet and small ones", {}};
    kept_ = std::move(sheets.surface);
    keep_parts(kept_, settings_, extent_, where_, report_.steps);
    filled_ = kept_;
    fill();
    check_is_no_sheet();
    steps_before_wrap_ = report_.steps.size();
    surface = filled_;
    remove_degenerate_faces(surface, report_.steps);
    if (!remove_crossings(surface, report_.steps)) return crossings_left(surface);
    if (!is_sound(to_soup(surface)))
      return {"local repairs leave the surface open or in several parts", {}};
    turn_outward(surface);
    return measured(surface);
  }

  void fill() {
    const std::vector<Hole> holes = fill_holes(filled_);
    if (holes.empty()) return;
    double largest = 0;
    for (const Hole& hole : holes) {
      largest = std::max(largest, hole.diameter);
      if (hole.diameter > settings_.max_hole * extent_ && !hole.is_flat())
        report_.warnings.push_back(
            text("a hole of ", millimetres(hole.diameter), " at ", position_text(hole.centre),
                 ", larger than max_hole = ", settings_.max_hole,
                 " of the extent, was filled with a patch of ", 1e6 * hole.area,
                 " mm^2; if the body goes on there, close the surface in a mesh editor"));
    }
    report_.steps.push_back(
        text("filled ", counted(holes.size(), "hole"), ", the largest of ", millimetres(largest)));
  }

  /// @throws FaultySurface where the faces, once their holes are filled, enclose next to nothing.
  void check_is_no_sheet() const {
    const double thickness = std::abs(mean_thickness(filled_));
    if (!filled_.triangles.empty() && thickness > kSheet * extent_) return;
    refuse_sheet(text("the faces do not bound a volume: filled, they enclose ",
                      1e9 * std::abs(signed_volume(filled_)), " mm^3 between sheets of ",
                      1e6 * area(filled_), " mm^2"));
  }

  [[noreturn]] void refuse_sheet(const std::string& problem) const {
    FaultyFaces faulty;
    for (const Triangle& t : kept_.triangles) faulty.add(kept_, t, Fault::BorderEdge);
    throw FaultySurface(where_, problem,
                        "export the surface of a solid, or give the sheet a thickness", faulty);
  }

  static Shortcoming crossings_left(const Surface& surface) {
    const std::vector<TrianglePair> pairs = self_intersections(surface);
    const Triangle& first = surface.triangles[to_index(pairs.front().first)];
    return {
        text("the surface self-intersects: ", counted(pairs.size(), "pair"),
             " of triangles, the first near ", position_text(surface.points[to_index(first[0])])),
        faces_of(surface, pairs)};
  }

  void turn_outward(Surface& surface) {
    if (signed_volume(surface) >= 0) return;
    for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
    report_.steps.push_back("reversed all faces: they pointed inward");
  }

  /// Writes the distances between what was kept and the result to the report.
  Change measure(const Surface& surface) {
    Change moved = change_between(kept_, surface, most_moved());
    const Change added = change_between(surface, kept_, most_moved());
    report_.moved = moved.distance;
    report_.moved_at = moved.at;
    report_.added = added.distance;
    report_.added_at = added.at;
    return moved;
  }

  Shortcoming measured(const Surface& surface) {
    Change moved = measure(surface);
    if (moved.distance <= most_moved()) return {};
    const std::string problem =
        text("local repairs move the surface by ", millimetres(moved.distance), " at ",
             position_text(moved.at), ", more than max_change = ", settings_.max_change,
             " of its extent");
    // A wrap would move more than this.
    if (moved.distance > kLittleMore * most_moved() || moved.far_fraction() > kFewFar)
      return {problem, std::move(moved.far_faces)};
    report_.warnings.push_back(
        text(problem, ", but only on ", 100 * moved.far_fraction(), " % of the area of the file"));
    return {};
  }

  /// @throws FaultySurface where no wrap is near enough.
  Surface wrapped_instead(Shortcoming& left) {
    for (const double fraction : kAlphas) {
      const double alpha = fraction * extent_;
      Surface wrap = alpha_wrap(filled_, alpha, alpha / kAlphaPerOffset);
      const bool is_finest = fraction == kAlphas.back();
      if (mean_thickness(wrap) < kSkin * alpha) {
        if (is_finest) refuse_sheet("the faces do not bound a volume: they are open sheets");
        continue;
      }
      const Change moved = measure(wrap);
      if (moved.far_fraction() > (is_finest ? kMostFar : kFewFar)) {
        if (is_finest) refuse_wrap(left, moved, alpha);
        continue;
      }
      tell_wrap(left.problem, moved, alpha);
      return wrap;
    }
    return {};
  }

  void tell_wrap(const std::string& problem, const Change& moved, double alpha) {
    report_.steps.resize(steps_before_wrap_);
    report_.steps.push_back(
        text("replaced the surface by its alpha wrap, alpha ", millimetres(alpha)));
    report_.warnings.push_back(
        text(problem, "; its alpha wrap replaces it, which bridges what is narrower than ",
             millimetres(alpha), ": ", 100 * moved.far_fraction(),
             " % of the area of the file lies farther than max_change from it, at most ",
             millimetres(moved.distance), " at ", position_text(moved.at)));
  }

  [[noreturn]] void refuse_wrap(Shortcoming& left, const Change& moved, double alpha) const {
    for (std::size_t f = 0; f < moved.far_faces.faults.size(); ++f) {
      const Vec3* corner = &moved.far_faces.points[3 * f];
      left.faces.add(corner[0], corner[1], corner[2], moved.far_faces.faults[f]);
    }
    throw FaultySurface(
        where_,
        text(left.problem, "; ", 100 * moved.far_fraction(),
             " % of its area lies farther than max_change = ", settings_.max_change,
             " of its extent from its alpha wrap of ", millimetres(alpha), ", at most ",
             millimetres(moved.distance), " at ", position_text(moved.at)),
        "raise surface.max_change, set surface.repair = \"wrap\" to take that wrap, or mend the "
        "surface there in a mesh editor",
        left.faces);
  }

  std::vector<std::size_t> names_of_triangles() const {
    std::vector<std::size_t> names;
    for (std::size_t p = 0; p < soup_.polygons.size(); ++p)
      names.insert(names.end(), soup_.polygons[p].size() - 2, soup_.names[p]);
    return names;
  }

  const Soup& soup_;
  const RepairSettings& settings_;
  const std::string& where_;
  RepairReport& report_;
  Surface original_;                   // the faces of the file
  Surface kept_;                       // those of the parts that are kept
  Surface filled_;                     // those and the patches in their holes
  double extent_;                      // m
  std::size_t steps_before_wrap_ = 0;  // those that a wrap builds on
};

}  // namespace

Surface repair(const Soup& soup, const RepairSettings& settings, const std::string& where,
               RepairReport& report) {
  return Repair(soup, settings, where, report).run();
}

}  // namespace palpate::mesher
