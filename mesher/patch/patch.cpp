// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/patch/patch.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/position_text.hpp"
#include "format/tangent_frame.hpp"
#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

constexpr double kSamePlace = 0.1;        ///< of the spacing
constexpr double kFlatterThanLine = 0.2;  ///< of the spacing, standard deviation across a line
constexpr double kLongEdge = 2;           ///< of the spacing, at the border
constexpr double kFlat = 0.25;            ///< of the spacing, height of a triangle over the border
constexpr double kFarApart = 3;           ///< of the spacing
constexpr double kLargestTilt = std::numbers::pi / 3;
constexpr double kOffSurface = 0.05;     ///< of the spacing
constexpr double kRobustDeviations = 6;  ///< 1.4826 times the median of the distances each
constexpr double kUnitWithin = 0.01;

double degrees(double angle) {
  return angle * 180 / std::numbers::pi;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A point in the plane of the patch.
struct Projected {
  double x = 0, y = 0, height = 0;
  double slope_x = 0, slope_y = 0;  ///< of the height, by the measured normal
};

double distance_in_plane(const Projected& a, const Projected& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

class PatchMaker {
 public:
  PatchMaker(const std::vector<ContactPoint>& points, const std::string& where)
      : points_(points), where_(where) {}

  Patch make() {
    check_numbers();
    project();
    check_places();
    check_line();
    triangulate();
    trim_border();
    check_far_points();
    check_facets();
    find_outliers();
    return std::move(patch_);
  }

 private:
  const std::string& name(std::size_t i) const { return points_[i].name; }

  void check_numbers() const {
    if (points_.size() < 3) {
      refuse(where_, fmt::format("{} contact points make no surface", points_.size()),
             "measure three sites or more, or give a body with --body");
    }
    for (const ContactPoint& p : points_) {
      if (!is_finite(p.position) || !is_finite(p.outward)) {
        refuse(where_, p.name + ": its contact point or normal is not finite",
               "mend the record, or leave the site out");
      }
      if (!(std::abs(norm(p.outward) - 1) < kUnitWithin)) {
        refuse(where_,
               fmt::format("{}: its normal has the length {}, not 1", p.name,
                           number_text(norm(p.outward))),
               "check the columns of the normal");
      }
    }
  }

  /// The plane is the one across the mean normal.
  void project() {
    Vec3 sum{};
    for (const ContactPoint& p : points_) sum = sum + p.outward;
    const double length = norm(sum);
    if (!(length > 0)) {
      refuse(where_, "the normals of its sites cancel", "check the columns of the normal");
    }
    const Vec3 up = patch_.mean_normal = (1 / length) * sum;
    const auto [first, second] = tangent_frame(up);
    for (const ContactPoint& p : points_) {
      const double along = dot(p.outward, up) / norm(p.outward);
      if (along < std::cos(kLargestTilt)) refuse_tilt(p, std::acos(std::clamp(along, -1.0, 1.0)));
      const Vec3 x = p.position - points_.front().position;
      plane_.push_back({dot(x, first), dot(x, second), dot(x, up),
                        -dot(p.outward, first) / dot(p.outward, up),
                        -dot(p.outward, second) / dot(p.outward, up)});
    }
  }

  [[noreturn]] void refuse_tilt(const ContactPoint& p, double tilt) const {
    refuse(where_,
           fmt::format("{} at {}: its normal is {:.0f} degrees off the mean normal of all sites, "
                       "which makes no height field",
                       p.name, position_text(p.position), degrees(tilt)),
           tilt > std::numbers::pi / 2
               ? "check the sign of its normal: normals point out of the body"
               : "measure sides that face apart as patches of their own, or give a body with "
                 "--body");
  }

  void check_places() {
    std::vector<double> nearest(points_.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> which(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t j = 0; j < points_.size(); ++j) {
        const double d = distance_in_plane(plane_[i], plane_[j]);
        if (i == j || d >= nearest[i]) continue;
        nearest[i] = d;
        which[i] = j;
      }
    }
    patch_.spacing = median_of(nearest);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (nearest[i] > kSamePlace * patch_.spacing) continue;
      refuse(where_,
             fmt::format("{} and {} are {} apart, the others {}", name(std::min(i, which[i])),
                         name(std::max(i, which[i])), length_text(nearest[i]),
                         length_text(patch_.spacing)),
             "leave one of them out with leave_out of the sidecar");
    }
    if (!(patch_.spacing > 0)) {
      refuse(where_, "its sites lie at the same places in pairs", "leave out the repeats");
    }
  }

  /// The smaller principal standard deviation in the plane.
  void check_line() const {
    const auto n = static_cast<double>(points_.size());
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (const Projected& p : plane_) {
      x += p.x / n;
      y += p.y / n;
    }
    for (const Projected& p : plane_) {
      xx += (p.x - x) * (p.x - x) / n;
      xy += (p.x - x) * (p.y - y) / n;
      yy += (p.y - y) * (p.y - y) / n;
    }
    const double smaller = 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy);
    if (std::sqrt(std::max(0.0, smaller)) > kFlatterThanLine * patch_.spacing) return;
    refuse(where_, fmt::format("its {} sites lie on one line and make no surface", points_.size()),
           "measure a second row of sites, or give a body with --body");
  }

  void triangulate() {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Vertices = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
    using Storage = CGAL::Triangulation_data_structure_2<Vertices>;
    CGAL::Delaunay_triangulation_2<Kernel, Storage> delaunay;
    for (std::size_t i = 0; i < plane_.size(); ++i) {
      delaunay.insert({plane_[i].x, plane_[i].y})->info() = static_cast<std::int32_t>(i);
    }
    for (const auto face : delaunay.finite_face_handles()) {
      patch_.triangles.push_back(
          {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    std::sort(patch_.triangles.begin(), patch_.triangles.end());
  }

  double length_of(const Edge& edge) const {
    return distance_in_plane(plane_[to_index(edge[0])], plane_[to_index(edge[1])]);
  }

  /// Edges with one triangle, with that triangle.
  std::map<Edge, std::size_t> border() const {
    std::map<Edge, std::size_t> once;
    std::set<Edge> twice;
    for (std::size_t t = 0; t < patch_.triangles.size(); ++t) {
      const Triangle& corners = patch_.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [a, b] = std::minmax(corners[i], corners[(i + 1) % 3]);
        if (!once.emplace(Edge{a, b}, t).second) twice.insert({a, b});
      }
    }
    for (const Edge& edge : twice) once.erase(edge);
    return once;
  }

  /// Whether the third corner of a triangle lies nearly on its edge.
  bool is_flat(const Edge& edge, std::size_t triangle) const {
    const Triangle& corners = patch_.triangles[triangle];
    const auto at = [&](std::size_t i) -> const Projected& { return plane_[to_index(corners[i])]; };
    const double twice_area =
        (at(1).x - at(0).x) * (at(2).y - at(0).y) - (at(2).x - at(0).x) * (at(1).y - at(0).y);
    return std::abs(twice_area) < kFlat * patch_.spacing * length_of(edge);
  }

  /// A hull has slivers along its outline, and long triangles where that is concave. The longest
  /// edge goes first; its triangle may go where its third corner is inside, so that every point
  /// keeps a triangle and no two borders meet [Duckham, Kulik, Worboys & Galton 2008].
  void trim_border() {
    while (true) {
      const std::map<Edge, std::size_t> edges = border();
      std::vector<bool> at_border(points_.size(), false);
      for (const auto& [edge, triangle] : edges)
        at_border[to_index(edge[0])] = at_border[to_index(edge[1])] = true;
      double longest = 0;
      std::ptrdiff_t goes = -1;
      for (const auto& [edge, triangle] : edges) {
        const bool is_long = length_of(edge) > kLongEdge * patch_.spacing;
        if (length_of(edge) <= longest || !(is_long || is_flat(edge, triangle))) continue;
        const Triangle& corners = patch_.triangles[triangle];
        const auto third =
            std::find_if(corners.begin(), corners.end(),
                         [&ends = edge](std::int32_t c) { return c != ends[0] && c != ends[1]; });
        if (at_border[to_index(*third)]) continue;
        longest = length_of(edge);
        goes = static_cast<std::ptrdiff_t>(triangle);
      }
      if (goes < 0) return;
      patch_.triangles.erase(patch_.triangles.begin() + goes);
    }
  }

  void check_far_points() const {
    std::vector<double> nearest(points_.size(), std::numeric_limits<double>::infinity());
    for (const Edge& edge : edges_of(patch_.triangles)) {
      for (const std::int32_t end : edge) {
        double& least = nearest[to_index(end)];
        least = std::min(least, length_of(edge));
      }
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (nearest[i] <= kFarApart * patch_.spacing) continue;
      refuse(where_,
             fmt::format("{} at {} is {} from the nearest of the others, whose spacing is {}",
                         name(i), position_text(points_[i].position), length_text(nearest[i]),
                         length_text(patch_.spacing)),
             "check its position, or leave it out with leave_out of the sidecar");
    }
  }

  void check_facets() {
    for (const Triangle& corners : patch_.triangles) {
      const auto at = [&](std::size_t i) { return points_[to_index(corners[i])].position; };
      const Vec3 area = cross(at(1) - at(0), at(2) - at(0));
      const Vec3 facet = (1 / norm(area)) * area;
      patch_.steepest = std::max(patch_.steepest,
                                 std::acos(std::clamp(dot(facet, patch_.mean_normal), -1.0, 1.0)));
      for (const std::int32_t corner : corners) {
        const ContactPoint& p = points_[to_index(corner)];
        const double turn = std::acos(std::clamp(dot(facet, p.outward) / norm(p.outward), -1., 1.));
        patch_.largest_turn = std::max(patch_.largest_turn, turn);
        if (turn < kLargestTilt) continue;
        refuse(where_,
               fmt::format("{} at {}: its normal is {:.0f} degrees off the surface through it and "
                           "its neighbours",
                           p.name, position_text(p.position), degrees(turn)),
               "check its position and normal, or leave it out with leave_out of the sidecar");
      }
    }
  }

  /// The distance of each point to the surface that each neighbour supposes.
  void find_outliers() {
    std::vector<std::vector<double>> misses(points_.size());
    for (const Edge& edge : edges_of(patch_.triangles)) {
      const Projected &a = plane_[to_index(edge[0])], &b = plane_[to_index(edge[1])];
      const double miss = a.height - b.height - 0.5 * (a.slope_x + b.slope_x) * (a.x - b.x) -
                          0.5 * (a.slope_y + b.slope_y) * (a.y - b.y);
      misses[to_index(edge[0])].push_back(miss);
      misses[to_index(edge[1])].push_back(-miss);
    }
    std::vector<double> distance;
    for (const auto& of_point : misses) distance.push_back(std::abs(median_of(of_point)));
    const double limit =
        std::max(kRobustDeviations * 1.4826 * median_of(distance), kOffSurface * patch_.spacing);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (distance[i] <= limit) continue;
      patch_.warnings.push_back(
          fmt::format("{} at {} lies {} off the surface of its neighbours, by their positions and "
                      "normals: check it, or leave it out",
                      name(i), position_text(points_[i].position), length_text(distance[i])));
    }
  }

  const std::vector<ContactPoint>& points_;
  const std::string& where_;
  std::vector<Projected> plane_;
  Patch patch_;
};

}  // namespace

Patch make_patch(const std::vector<ContactPoint>& points, const std::string& where) {
  return PatchMaker(points, where).make();
}

std::optional<PatchPlace> place_on(const Patch& patch, const std::vector<ContactPoint>& points,
                                   const Vec3& position) {
  constexpr double kOnEdge = 1e-9;
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    const auto corner = [&](std::size_t i) {
      return points[to_index(patch.triangles[t][i % 3])].position;
    };
    PatchPlace place{t, {}};
    const double area = dot(cross(corner(1) - corner(0), corner(2) - corner(0)), patch.mean_normal);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 opposite = cross(corner(i + 1) - position, corner(i + 2) - position);
      place.natural[i] = dot(opposite, patch.mean_normal) / area;
    }
    if (*std::min_element(place.natural.begin(), place.natural.end()) >= -kOnEdge) return place;
  }
  return {};
}

}  // namespace palpate::mesher
