// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/response/response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "format/error.hpp"
#include "format/origin_distance.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {
namespace {

// The runtime requires 0 and 0.5; the margin covers rounding.
constexpr double kLeastCosine = 0.1;     // of u_l with the inward facet normal
constexpr double kLeastMeanNorm = 0.55;  // |sum n_l u_l|
constexpr int kMaxSweeps = 500;
/// A press turned by more is told from a normal one.
constexpr double kOblique = 15 * std::numbers::pi / 180;

double angle_at(const Vec3& apex, const Vec3& b, const Vec3& c) {
  return std::atan2(norm(cross(b - apex, c - apex)), dot(b - apex, c - apex));
}

/// The negated facet normals around each vertex, weighted by the angle of the facet there
/// [Thuermer & Wuthrich 1998].
std::vector<Vec3> mean_inward(const Surface& boundary, std::size_t vertices,
                              const Marks& constrained) {
  std::vector<Vec3> free(vertices), any(vertices);
  for (const Triangle& t : boundary.triangles) {
    const Vec3 normal = unit(area_vector(boundary.points, t));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = to_index(t[k]);
      if (v >= vertices) continue;
      const auto at = [&](std::size_t i) { return boundary.points[to_index(t[i])]; };
      const Vec3 weighted = angle_at(at(k), at((k + 1) % 3), at((k + 2) % 3)) * normal;
      any[v] = any[v] - weighted;
      if (!all_marked(t, constrained)) free[v] = free[v] - weighted;
    }
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    const Vec3 mean = norm(free[v]) > 1e-6 ? free[v] : any[v];
    // Where the normals cancel any direction is a start for the sweeps below.
    free[v] = norm(mean) > 1e-6 ? unit(mean) : Vec3{0, 0, 1};
  }
  return free;
}

/// The triangles with a corner that is not constrained, with their unit inward normals.
struct OpenTriangles {
  std::vector<Triangle> triangles;
  std::vector<Vec3> inward_normal;
};

OpenTriangles open_triangles(const Surface& response, const Marks& constrained) {
  OpenTriangles open;
  for (const Triangle& t : response.triangles) {
    if (all_marked(t, constrained)) continue;
    open.triangles.push_back(t);
    open.inward_normal.push_back(-unit(area_vector(response.points, t)));
  }
  return open;
}

/// One pass over the conditions. Each violated condition turns its directions a little towards
/// meeting it (the perceptron rule, which converges when a solution exists).
/// @return the vertices of the triangles that violated a condition
std::vector<std::int32_t> sweep(const OpenTriangles& open, std::vector<Vec3>& inward) {
  std::vector<std::int32_t> violating;
  for (std::size_t m = 0; m < open.triangles.size(); ++m) {
    const Vec3& normal = open.inward_normal[m];
    std::array<Vec3*, 3> u{};
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = &inward[to_index(open.triangles[m][k])];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double cosine = dot(*u[k], normal);
      if (cosine >= kLeastCosine) continue;
      violating.push_back(open.triangles[m][k]);
      *u[k] = unit(*u[k] + (2 * kLeastCosine - cosine) * normal);
    }
    if (origin_to_triangle(*u[0], *u[1], *u[2]) >= kLeastMeanNorm) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      violating.push_back(open.triangles[m][k]);
      *u[k] = unit(*u[k] + 0.1 * normal);
    }
  }
  std::sort(violating.begin(), violating.end());
  violating.erase(std::unique(violating.begin(), violating.end()), violating.end());
  return violating;
}

/// Whether the directions at the corners of a triangle meet the conditions of the runtime.
bool meets_conditions(const Vec3& inward_normal, const std::array<Vec3, 3>& u) {
  return std::all_of(u.begin(), u.end(),
                     [&](const Vec3& x) { return dot(x, inward_normal) >= kLeastCosine; }) &&
         origin_to_triangle(u[0], u[1], u[2]) >= kLeastMeanNorm;
}

void turn_for_slides(const Surface& response, const Marks& constrained, const SlideDemand& demand,
                     InwardDirections& result) {
  std::vector<bool> free;
  for (std::size_t v = 0; v < response.points.size(); ++v) free.push_back(constrained[v] == 0);
  const Surface open{response.points, open_triangles(response, constrained).triangles, {}, {}};
  SlideDirections turned = slide_directions(
      open, std::move(result.inward), free, demand,
      [&](std::size_t t, const std::array<Vec3, 3>& u) {
        return meets_conditions(-unit(area_vector(open.points, open.triangles[t])), u);
      });
  result.inward = std::move(turned.inward);
  result.unbounded = turned.unbounded;
  result.still_unbounded = turned.still_unbounded;
}

/// @return how many response vertices are no sites because a support is within the tool radius
std::size_t exclude_sites_at_supports(ResponseSurface& response, const Surface& boundary,
                                      const Marks& constrained, double tool_radius) {
  std::size_t excluded = 0;
  for (std::size_t v = 0; v < response.is_site.size(); ++v) {
    if (response.is_site[v] == 0) continue;
    for (std::size_t i = 0; i < boundary.points.size(); ++i) {
      if (constrained[i] == 0 || norm(boundary.points[i] - boundary.points[v]) > tool_radius)
        continue;
      response.is_site[v] = 0;
      ++excluded;
      break;
    }
  }
  return excluded;
}

long degrees(double radians) {
  return std::lround(radians * 180 / std::numbers::pi);
}

/// How directions differ from mean normals: how many, how far, and where farthest.
void tell_turns(const InwardDirections& directions, const NestedSurface& nested,
                std::string_view purpose, const Log& log) {
  std::string line = text("press directions: ", directions.adjusted, " of ",
                          directions.inward.size(), " adjusted for ", purpose);
  if (directions.adjusted > 0)
    line += text(", by ", degrees(directions.largest_turn), " degrees at most, near ",
                 position_text(nested.response.points[directions.turned_most]));
  note(log, line);
}

/// What turning directions for slides has gained, and what it costs.
void tell_slides(const InwardDirections& directions, std::size_t triangles, const Log& log) {
  note(log, text("slides: by its shape, ", directions.unbounded, " of ", triangles,
                 " triangles have no bound with mean normals, ", directions.still_unbounded,
                 " with the adjusted press directions"));
  if (directions.largest_turn <= kOblique) return;
  warn(log, text("with press_directions = \"sliding\" a tool is pressed up to ",
                 degrees(directions.largest_turn),
                 " degrees off the normal: it pushes the tissue aside there, and its force leans "
                 "with it"));
}

}  // namespace

InwardDirections inward_directions(const Surface& response, const Surface& boundary,
                                   const Marks& constrained,
                                   const std::optional<SlideDemand>& demand) {
  InwardDirections result;
  result.inward = mean_inward(boundary, response.points.size(), constrained);
  const std::vector<Vec3> mean = result.inward;
  const OpenTriangles open = open_triangles(response, constrained);
  for (int i = 0; i < kMaxSweeps; ++i) {
    result.unresolved = sweep(open, result.inward);
    if (result.unresolved.empty()) break;
  }
  if (demand) turn_for_slides(response, constrained, *demand, result);
  for (std::size_t v = 0; v < mean.size(); ++v) {
    const double cosine = dot(mean[v], result.inward[v]);
    if (cosine >= 1 - 1e-12) continue;
    ++result.adjusted;
    const double turn = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (turn <= result.largest_turn) continue;
    result.largest_turn = turn;
    result.turned_most = v;
  }
  return result;
}

void set_response(Body& body, const NestedSurface& nested, const Marks& constrained,
                  const Settings& settings) {
  const Log& log = settings.log;
  ResponseSurface& response = body.response;
  response.triangles = nested.response.triangles;
  std::optional<SlideDemand> demand;
  if (settings.directions == PressDirections::Sliding && settings.depth > 0)
    demand = SlideDemand{.depth = settings.depth};
  const InwardDirections directions =
      inward_directions(nested.response, nested.boundary, constrained, demand);
  response.inward = directions.inward;
  for (std::size_t v = 0; v < nested.response.points.size(); ++v) {
    response.node.push_back(static_cast<std::int32_t>(v));
    response.is_site.push_back(constrained[v] != 0 ? 0 : 1);
  }
  const std::size_t close =
      exclude_sites_at_supports(response, nested.boundary, constrained, settings.tool_radius);
  if (close > 0) {
    note(log, text("supports: ", counted(close, "response vertex", "response vertices"),
                   " within a tool radius (", millimetres(settings.tool_radius), ") of them ",
                   close == 1 ? "is no site" : "are no sites"));
  }
  tell_turns(directions, nested, demand ? "interpolation and slides" : "interpolation", log);
  if (demand) tell_slides(directions, response.triangles.size(), log);
  if (directions.unresolved.empty()) return;
  for (const std::int32_t v : directions.unresolved) {
    response.is_site[to_index(v)] = 0;
  }
  const bool one = directions.unresolved.size() == 1;
  warn(log,
       text(counted(directions.unresolved.size(), "response vertex", "response vertices"),
            one ? " becomes a hole" : " become holes",
            ": no direction points into all triangles around ", one ? "it, at " : "one, first at ",
            position_text(nested.response.points[to_index(directions.unresolved.front())])));
}

void check_sites(const Body& body, const Settings& settings, const Surface& boundary) {
  const auto& site = body.response.is_site;
  if (std::find(site.begin(), site.end(), std::uint8_t{1}) != site.end()) return;
  if (!settings.press.empty())
    throw Error(
        ErrorKind::Geometry, settings.source().string(),
        text("no response vertex is a site: none lies in a [[press]] zone, off the supports "
             "by the tool radius of ",
             millimetres(settings.tool_radius)),
        text("move or enlarge the zones: the body spans ", extent_of(boundary.points)));
  throw Error(
      ErrorKind::Geometry, settings.source().string(),
      text("no response vertex is a site: each is on a support or within the tool radius, ",
           millimetres(settings.tool_radius), ", of one"),
      text("make the supports or the tool smaller: the body spans ", extent_of(boundary.points)));
}

}  // namespace palpate::mesher
