// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/mesher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "format/error.hpp"
#include "mesher/curved_skin.hpp"
#include "mesher/fill.hpp"
#include "mesher/quality.hpp"
#include "mesher/queries.hpp"
#include "mesher/read_surface.hpp"
#include "mesher/remesh.hpp"
#include "mesher/response.hpp"
#include "mesher/text.hpp"
#include "mesher/thickness.hpp"

namespace palpate::mesher {
namespace {

// A tool pressed deeper than this part of the thickness squeezes the rest beyond what a strain
// energy law, or a mesh of this kind, can follow (nominal strain -0.8).
constexpr double kDeepestFraction = 0.8;

// Nodes this part of element_size outside a support still lie on its border but for rounding.
constexpr double kSupportTolerance = 1e-3;

[[noreturn]] void refuse_setting(const std::string& problem, const std::string& remedy) {
  throw Error(ErrorKind::Configuration, "mesh", problem, remedy);
}

void check_settings(const Settings& s) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!positive(s.patch_spacing) || !positive(s.element_size)) {
    refuse_setting("patch_spacing and element_size must be positive lengths", "correct the case");
  }
  if (!std::isfinite(s.interior_growth) || s.interior_growth < 1) {
    refuse_setting(text("interior_growth is ", s.interior_growth, ", below 1"),
                   "give 1 for a uniform mesh or more for a coarser interior");
  }
  if (!(s.feature_angle > 0 && s.feature_angle <= 180)) {
    refuse_setting(text("feature_angle is ", s.feature_angle, " degrees"), "give 0 .. 180");
  }
  const auto not_negative = [](double value) { return std::isfinite(value) && value >= 0; };
  if (!positive(s.tool_radius) || !not_negative(s.depth) || !not_negative(s.lateral_travel)) {
    refuse_setting("tool_radius must be positive, depth and lateral_travel not negative",
                   "correct the case");
  }
  const auto check_unit = [&](const SurfaceFile& file) {
    if (!positive(file.unit)) {
      refuse_setting(text("the unit of ", file.path.string(), " is ", file.unit, " m"),
                     "give a positive length, 0.001 for millimetres");
    }
  };
  std::vector<Support> supports = s.supports;
  for (const Springs& springs : s.foundation) {
    supports.push_back(springs.where);
    const auto stiffness = [](double value) { return std::isfinite(value) && value >= 0; };
    if (!stiffness(springs.normal_stiffness) || !stiffness(springs.tangential_stiffness) ||
        springs.normal_stiffness + springs.tangential_stiffness == 0) {
      refuse_setting(text("springs of ", springs.normal_stiffness, " and ",
                          springs.tangential_stiffness, " N/m^3"),
                     "give stiffnesses that are not negative, one of them positive");
    }
  }
  for (const Support& support : supports) {
    const auto* plane = std::get_if<PlaneSupport>(&support);
    if (plane && !positive(norm(plane->normal))) {
      refuse_setting("the normal of a plane support has no direction", "correct the case");
    }
    const auto* near = std::get_if<SurfaceSupport>(&support);
    if (near == nullptr) continue;
    check_unit(near->surface);
    if (!std::isfinite(near->distance) || near->distance < 0) {
      refuse_setting(text("the distance of a surface support is ", near->distance, " m"),
                     "give 0 or more");
    }
  }
  check_unit(s.surface);
  for (const SurfaceFile& inclusion : s.inclusions) check_unit(inclusion);
}

/// Inclusions that share no point with the skin or with one another, all inside the one and none
/// inside the other.
void check_inclusions(const Settings& settings, const Surface& skin,
                      const std::vector<Surface>& inclusions) {
  const auto refuse = [&](std::size_t i, const std::string& problem, const std::string& remedy) {
    throw Error(ErrorKind::Geometry, settings.inclusions[i].path.string(), problem, remedy);
  };
  const SurfaceQuery inside_skin(skin);
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    if (surfaces_meet(skin, inclusions[i])) {
      refuse(i, "the inclusion touches or cuts the skin", "move or shrink it");
    }
    if (!inside_skin.contains(inclusions[i].points.front())) {
      refuse(i, "the inclusion lies outside the skin", "check its position and its unit");
    }
    const SurfaceQuery inside_this(inclusions[i]);
    for (std::size_t j = 0; j < inclusions.size(); ++j) {
      if (i == j) continue;
      const std::string other = settings.inclusions[j].path.string();
      if (surfaces_meet(inclusions[i], inclusions[j])) {
        refuse(i, "the inclusion touches or cuts " + other, "keep inclusions apart");
      }
      if (inside_this.contains(inclusions[j].points.front())) {
        refuse(i, "the inclusion contains " + other, "nested inclusions are not supported");
      }
    }
  }
}

/// Region of each part of the filling: 0, or 1 + the inclusion that contains its largest element.
std::map<std::int32_t, std::int32_t> regions_of_parts(const Filling& filling,
                                                      const std::vector<Surface>& inclusions) {
  std::map<std::int32_t, std::pair<double, std::size_t>> largest;
  for (std::size_t t = 0; t < filling.tetrahedra.size(); ++t) {
    const double v = volume(filling.nodes, filling.tetrahedra[t]);
    auto& entry = largest[filling.part[t]];
    if (v > entry.first) entry = {v, t};
  }
  const std::vector<SurfaceQuery> queries(inclusions.begin(), inclusions.end());
  std::map<std::int32_t, std::int32_t> region;
  for (const auto& [part, entry] : largest) {
    Vec3 centroid{};
    for (const std::int32_t v : filling.tetrahedra[entry.second]) {
      centroid = centroid + 0.25 * filling.nodes[static_cast<std::size_t>(v)];
    }
    region[part] = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (queries[i].contains(centroid)) region[part] = static_cast<std::int32_t>(i) + 1;
    }
  }
  return region;
}

std::string name_or(const std::string& name, const std::string& fallback) {
  return name.empty() ? fallback : name;
}

void set_regions(Body& body, const Settings& settings, const Filling& filling,
                 const std::vector<Surface>& inclusions) {
  body.region_names.push_back(name_or(settings.surface.region_name, "matrix"));
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    body.region_names.push_back(
        name_or(settings.inclusions[i].region_name, text("inclusion_", i + 1)));
  }
  const auto region = regions_of_parts(filling, inclusions);
  for (const std::int32_t part : filling.part) {
    body.tetrahedron_region.push_back(region.at(part));
  }
}

/// Which known names of a surface hold the label.
std::vector<bool> bearing(const std::string& label, const Surface& skin, const std::string& where) {
  std::vector<bool> bears;
  std::set<std::string> all;
  bool found = false;
  for (const Names& names : skin.known_names) {
    all.insert(names.begin(), names.end());
    bears.push_back(std::find(names.begin(), names.end(), label) != names.end());
    found = found || bears.back();
  }
  if (found) return bears;
  std::string list;
  for (const std::string& name : all) list += (list.empty() ? "" : ", ") + name;
  throw Error(ErrorKind::Configuration, where,
              text("no face bears the name '", label, "', which a support asks for"),
              all.empty() ? "name faces by 'g', 'o' or 'usemtl' in an OBJ file; other kinds of "
                            "file carry no names"
                          : text("use one of ", list));
}

/// Points within `tolerance` of a face that bears the label. The nearest face, or one that shares a
/// corner with it, is that face.
std::vector<std::uint8_t> points_on(const LabelSupport& support, const Surface& skin,
                                    const std::string& where, const std::vector<Vec3>& points,
                                    double tolerance) {
  const std::vector<bool> bears = bearing(support.label, skin, where);
  const SurfaceQuery query(skin);
  const auto around = incident_triangles(skin.points.size(), skin.triangles);
  const auto lies_on = [&](const Vec3& x, std::int32_t t) {
    const auto triangle = static_cast<std::size_t>(t);
    const auto corner = [&](std::size_t k) {
      return skin.points[static_cast<std::size_t>(skin.triangles[triangle][k])];
    };
    return bears[skin.names[triangle]] &&
           distance_to_triangle(x, corner(0), corner(1), corner(2)) <= tolerance;
  };
  std::vector<std::uint8_t> on(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto nearest = static_cast<std::size_t>(query.closest(points[i]).triangle);
    for (const std::int32_t corner : skin.triangles[nearest])
      for (const std::int32_t t : around[static_cast<std::size_t>(corner)])
        if (lies_on(points[i], t)) on[i] = 1;
  }
  return on;
}

/// The boundary points inside a support, with a margin for rounding.
std::vector<std::uint8_t> points_inside(const Support& support, const Settings& settings,
                                        const Surface& skin, const Surface& boundary) {
  std::vector<std::uint8_t> inside(boundary.points.size(), 0);
  const double tolerance = kSupportTolerance * settings.element_size;
  if (const auto* label = std::get_if<LabelSupport>(&support)) {
    return points_on(*label, skin, settings.surface.path.string(), boundary.points, tolerance);
  }
  if (const auto* near = std::get_if<SurfaceSupport>(&support)) {
    const SurfaceQuery surface(read_surface(near->surface, settings.log));
    for (std::size_t i = 0; i < inside.size(); ++i)
      inside[i] = is_near(surface, boundary.points[i], near->distance + tolerance) ? 1 : 0;
  } else {
    for (std::size_t i = 0; i < inside.size(); ++i)
      inside[i] = is_held({support}, boundary.points[i], tolerance) ? 1 : 0;
  }
  return inside;
}

void add(std::vector<std::uint8_t>& marks, const std::vector<std::uint8_t>& more) {
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i] |= more[i];
}

/// Held boundary points; every one of them a node of the same number.
std::vector<std::uint8_t> set_supports(Body& body, const Settings& settings, const Surface& skin,
                                       const Surface& boundary) {
  std::vector<std::uint8_t> held(boundary.points.size(), 0);
  for (const Support& support : settings.supports)
    add(held, points_inside(support, settings, skin, boundary));
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i] != 0) body.fixed_nodes.push_back(static_cast<std::int32_t>(i));
  return held;
}

/// The facets on springs. @return their nodes, marked.
std::vector<std::uint8_t> set_foundation(Body& body, const Settings& settings, const Surface& skin,
                                         const Surface& boundary) {
  std::vector<std::uint8_t> sprung(boundary.points.size(), 0);
  std::map<std::int32_t, SprungFacet> facets;
  for (const Springs& springs : settings.foundation) {
    const auto inside = points_inside(springs.where, settings, skin, boundary);
    for (std::size_t f = 0; f < boundary.triangles.size(); ++f) {
      if (!all_held(boundary.triangles[f], inside)) continue;
      const auto number = static_cast<std::int32_t>(f);
      SprungFacet& facet = facets[number];
      facet.facet = number;
      facet.normal_stiffness += springs.normal_stiffness;
      facet.tangential_stiffness += springs.tangential_stiffness;
      for (const std::int32_t node : boundary.triangles[f])
        sprung[static_cast<std::size_t>(node)] = 1;
    }
  }
  for (const auto& [number, facet] : facets) body.foundation.push_back(facet);
  if (!settings.foundation.empty() && facets.empty()) {
    const Bounds box = bounds(boundary.points);
    throw Error(ErrorKind::Geometry, settings.surface.path.string(),
                "the supports with springs hold no facet",
                text("place them on the body, which spans ", millimetres(box.low), " to ",
                     millimetres(box.high)));
  }
  return sprung;
}

/// The six rigid motions about a point, displacements at x for a unit of each: three shifts, three
/// turns by 1/length.
std::array<Vec3, 6> rigid_motions(const Vec3& x, double length) {
  const Vec3 r = (1 / length) * x;
  return {Vec3{1, 0, 0},        Vec3{0, 1, 0},        Vec3{0, 0, 1},
          Vec3{0, -r[2], r[1]}, Vec3{r[2], 0, -r[0]}, Vec3{-r[1], r[0], 0}};
}

/// Whether elimination of a symmetric matrix, the largest pivot first, meets none near 0.
bool is_definite(std::array<std::array<double, 6>, 6> K) {
  double first = 0;
  std::array<bool, 6> done{};
  for (std::size_t step = 0; step < 6; ++step) {
    std::size_t p = 6;
    for (std::size_t i = 0; i < 6; ++i)
      if (!done[i] && (p == 6 || K[i][i] > K[p][p])) p = i;
    first = std::max(first, K[p][p]);
    if (!(K[p][p] > 1e-6 * first)) return false;
    done[p] = true;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t k = 0; k < 6 && !done[i]; ++k)
        if (k != p) K[i][k] -= K[i][p] / K[p][p] * K[p][k];
  }
  return true;
}

/// A point that is held, or rests on springs along a direction and across it.
struct Supported {
  Vec3 x{};
  Vec3 normal{1, 0, 0};
  double along = 1, across = 1;

  double resistance(const Vec3& a, const Vec3& b) const {
    return across * dot(a, b) + (along - across) * dot(a, normal) * dot(b, normal);
  }
};

std::vector<Supported> supported_points(const Body& body, const Surface& boundary) {
  const auto at = [&](std::int32_t i) { return boundary.points[static_cast<std::size_t>(i)]; };
  std::vector<Supported> points;
  for (const std::int32_t node : body.fixed_nodes) points.push_back({at(node)});
  for (const SprungFacet& sprung : body.foundation) {
    const Triangle& facet = boundary.triangles[static_cast<std::size_t>(sprung.facet)];
    const double most = std::max(sprung.normal_stiffness, sprung.tangential_stiffness);
    for (const std::int32_t node : facet)
      points.push_back({at(node), unit(area_vector(boundary.points, facet)),
                        sprung.normal_stiffness / most, sprung.tangential_stiffness / most});
  }
  return points;
}

/// Whether held points and springs resist every rigid motion: their stiffness against the six of
/// them, relative to the stiffest spring of each facet, is definite.
bool stops_rigid_motion(const std::vector<Supported>& points) {
  double length = 0;
  for (const Supported& point : points) length = std::max(length, norm(point.x - points.front().x));
  if (length == 0) return false;
  std::array<std::array<double, 6>, 6> K{};
  for (const Supported& point : points) {
    const auto motion = rigid_motions(point.x - points.front().x, length);
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b) K[a][b] += point.resistance(motion[a], motion[b]);
  }
  return is_definite(K);
}

void check_supports(const Body& body, const Settings& settings, const Surface& boundary) {
  const std::string where = settings.surface.path.string();
  const Bounds box = bounds(boundary.points);
  const std::string extent =
      text("the body spans ", millimetres(box.low), " to ", millimetres(box.high));
  if (!stops_rigid_motion(supported_points(body, boundary))) {
    const std::string springs =
        body.foundation.empty()
            ? std::string()
            : text(" and ", counted(body.foundation.size(), "facet"), " on springs");
    throw Error(ErrorKind::Geometry, where,
                text("the supports hold ", body.fixed_nodes.size(), " of ", boundary.points.size(),
                     " surface nodes", springs, ", the body would float"),
                (springs.empty() ? "place a support on it: "
                                 : "give tangential_stiffness, or place a support on it: ") +
                    extent);
  }
  const auto& site = body.response.is_site;
  if (std::find(site.begin(), site.end(), std::uint8_t{1}) == site.end()) {
    throw Error(ErrorKind::Geometry, where,
                text("the supports hold every response vertex, or come within the radius of the "
                     "tool, ",
                     millimetres(settings.tool_radius), ", of it: nothing can be touched"),
                "make the supports or the tool smaller: " + extent);
  }
}

/// A tool pressed closer to a support than its radius would feel the support instead of the body.
/// @return how many response vertices that are not held themselves lie so close.
std::size_t exclude_sites_at_supports(ResponseSurface& response, const Surface& boundary,
                                      const std::vector<std::uint8_t>& held, double tool_radius) {
  std::size_t excluded = 0;
  for (std::size_t v = 0; v < response.is_site.size(); ++v) {
    if (response.is_site[v] == 0) continue;
    for (std::size_t i = 0; i < boundary.points.size(); ++i) {
      if (held[i] == 0 || norm(boundary.points[i] - boundary.points[v]) > tool_radius) continue;
      response.is_site[v] = 0;
      ++excluded;
      break;
    }
  }
  return excluded;
}

/// Where the geometry forced the largest change, and by how much.
std::string most_turned(const InwardDirections& directions, const NestedSurface& nested) {
  const Vec3& x = nested.response.points[directions.turned_most];
  return text(", by ", std::lround(directions.largest_turn * 57.29577951308232),
              " degrees at most, near ", millimetres(x));
}

void set_response(Body& body, const NestedSurface& nested, const std::vector<std::uint8_t>& held,
                  const Settings& settings) {
  const Log& log = settings.log;
  ResponseSurface& response = body.response;
  response.triangles = nested.response.triangles;
  InwardDirections directions = inward_directions(nested.response, nested.boundary, held);
  response.inward = std::move(directions.inward);
  for (std::size_t v = 0; v < nested.response.points.size(); ++v) {
    response.node.push_back(static_cast<std::int32_t>(v));
    response.is_site.push_back(held[v] != 0 ? 0 : 1);
  }
  const std::size_t close =
      exclude_sites_at_supports(response, nested.boundary, held, settings.tool_radius);
  if (close > 0) {
    note(log, text("supports: ", counted(close, "response point"), " within a tool radius (",
                   millimetres(settings.tool_radius), ") of them ", close == 1 ? "is" : "are",
                   " no site"));
  }
  note(log, text("inward directions: ", directions.adjusted, " of ", response.inward.size(),
                 " turned so that they can be interpolated",
                 directions.adjusted == 0 ? std::string() : most_turned(directions, nested)));
  if (directions.unresolved.empty()) return;
  for (const std::int32_t v : directions.unresolved) {
    response.is_site[static_cast<std::size_t>(v)] = 0;
  }
  note(
      log,
      text("WARNING: ", counted(directions.unresolved.size(), "response point"),
           " cannot be sites: no direction points into all triangles around them; the first is at ",
           millimetres(
               nested.response.points[static_cast<std::size_t>(directions.unresolved.front())])));
}

void check_depth(const Body& body, const Settings& settings, const Surface& boundary) {
  if (settings.depth <= 0) return;
  const auto thickness = thickness_under_tool(boundary, body.response.inward, settings.tool_radius);
  std::size_t thin = 0, thinnest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < thickness.size(); ++v) {
    if (body.response.is_site[v] == 0) continue;
    if (settings.depth > kDeepestFraction * thickness[v]) ++thin;
    if (thickness[v] < least) {
      least = thickness[v];
      thinnest = v;
    }
  }
  if (thin > 0) {
    throw Error(ErrorKind::Geometry, settings.surface.path.string(),
                text("a depth of ", millimetres(settings.depth), " is more than ", kDeepestFraction,
                     " of the thickness at ", counted(thin, "site"), ": only ", millimetres(least),
                     " at ", millimetres(boundary.points[thinnest])),
                text("reduce the depth below ", millimetres(kDeepestFraction * least),
                     " or hold the thin part in a support"));
  }
  note(settings.log, text("depth: ", millimetres(settings.depth), " of at least ",
                          millimetres(least), " under every site"));
}

void check_volumes(const Quality& quality, const Surface& boundary, const std::string& where) {
  const double enclosed = signed_volume(boundary);
  if (!(std::abs(quality.volume - enclosed) <= 1e-9 * enclosed)) {
    throw Error(ErrorKind::Internal, where,
                text("the tetrahedra fill ", quality.volume, " m^3 of the ", enclosed,
                     " m^3 enclosed by the boundary"),
                "change element_size or patch_spacing a little and report the case");
  }
}

double largest_extent(const Surface& skin) {
  const Bounds box = bounds(skin.points);
  const Vec3 span = box.high - box.low;
  return std::max({span[0], span[1], span[2]});
}

/// Refuse patches that leave nothing of the shape; usually the unit of the surface is wrong.
void check_spacing(const Settings& settings, const Surface& skin) {
  constexpr double fewest = 3;  // patches along the largest extent
  const double largest = largest_extent(skin);
  if (fewest * settings.patch_spacing <= largest) return;
  throw Error(ErrorKind::Configuration, settings.surface.path.string(),
              text("the largest extent of the body is ", millimetres(largest),
                   ", too little for patches of ", millimetres(settings.patch_spacing)),
              text("check the unit of the surface, or reduce patch_spacing below ",
                   millimetres(largest / fewest)));
}

/// Refuse drags that leave the body wherever they start: each would end early, after a long time.
void check_lateral_travel(const Settings& settings, const Surface& skin) {
  const double largest = largest_extent(skin);
  if (settings.lateral_travel <= largest) return;
  throw Error(ErrorKind::Geometry, settings.surface.path.string(),
              text("a lateral travel of ", millimetres(settings.lateral_travel),
                   " is longer than the body, ", millimetres(largest)),
              "reduce lateral_travel to what a tool slides before it slips, or check the unit of "
              "the surface");
}

/// Refuse sizes that would fill the memory before anything is computed.
void check_counts(const Settings& settings, const Surface& skin) {
  const double h = settings.element_size, largest = 2e6;
  const double facets = area(skin) / (0.43 * h * h);  // equilateral triangles of edge h
  const double interior = 1.5 * signed_volume(skin) / std::pow(settings.interior_growth * h, 3);
  if (facets > largest || interior > largest) {
    throw Error(ErrorKind::Configuration, settings.surface.path.string(),
                text("an element_size of ", millimetres(h), " needs about ", facets,
                     " boundary facets and ", interior, " interior nodes, more than ", largest),
                "increase element_size or interior_growth, or check the unit of the surface");
  }
}

NestedSurface remesh_skin(const Settings& settings, const Surface& skin) {
  const int subdivisions =
      std::max(1, static_cast<int>(std::lround(settings.patch_spacing / settings.element_size)));
  NestedSurface nested = remesh(
      skin, {settings.patch_spacing, subdivisions, settings.feature_angle, settings.curved_facets},
      settings.surface.path.string(), settings.log);
  note(settings.log, text("response surface: ", nested.response.points.size(), " vertices, ",
                          nested.response.triangles.size(), " triangles; each divided into ",
                          subdivisions, " x ", subdivisions, " facets"));
  return nested;
}

/// Skin and inclusions in one list of triangles, the skin first.
Surface join_shells(const Settings& settings, const Surface& boundary,
                    const std::vector<Surface>& inclusions) {
  Surface shells = boundary;
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (surfaces_meet(inclusions[i], inclusions[j])) {
        throw Error(ErrorKind::Geometry, settings.inclusions[i].path.string(),
                    "remeshed to element_size, the inclusion touches another one",
                    "reduce element_size or move them apart");
      }
    }
    if (surfaces_meet(boundary, inclusions[i])) {
      throw Error(ErrorKind::Geometry, settings.inclusions[i].path.string(),
                  "remeshed to element_size, the inclusion touches the skin",
                  "reduce element_size and patch_spacing or move it inward");
    }
    append(shells, inclusions[i]);
  }
  return shells;
}

std::vector<Surface> remesh_inclusions(const Settings& settings,
                                       const std::vector<Surface>& inclusions) {
  std::vector<Surface> remeshed;
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    remeshed.push_back(remesh(inclusions[i], {settings.element_size, 1, settings.feature_angle},
                              settings.inclusions[i].path.string(), settings.log)
                           .boundary);
  }
  return remeshed;
}

void curve_skin(Body& body, const NestedSurface& nested, const Settings& settings) {
  body.curved_edges = nested.curved;
  const std::size_t drawn_back = draw_back_edges(body);
  if (drawn_back > 0) {
    note(settings.log,
         text(counted(drawn_back, "edge"), " of ", nested.curved.size(),
              " do not follow the skin all the way: an element under them would fold"));
  }
}

}  // namespace

Body mesh(const Settings& settings) {
  check_settings(settings);
  const std::string where = settings.surface.path.string();
  const Surface skin = read_surface(settings.surface, settings.log);
  std::vector<Surface> inclusions;
  for (const SurfaceFile& file : settings.inclusions) {
    inclusions.push_back(read_surface(file, settings.log));
  }
  check_inclusions(settings, skin, inclusions);
  check_spacing(settings, skin);
  check_lateral_travel(settings, skin);
  check_counts(settings, skin);

  const NestedSurface nested = remesh_skin(settings, skin);
  Body body;
  body.name = name_or(settings.name, settings.surface.path.stem().string());
  body.boundary = nested.boundary.triangles;
  auto held = set_supports(body, settings, skin, nested.boundary);
  add(held, set_foundation(body, settings, skin, nested.boundary));
  set_response(body, nested, held, settings);
  check_supports(body, settings, nested.boundary);
  check_depth(body, settings, nested.boundary);

  inclusions = remesh_inclusions(settings, inclusions);
  const Surface shells = join_shells(settings, nested.boundary, inclusions);
  Filling filling = fill(shells, settings.interior_growth * settings.element_size, where);
  if (filling.cut_short) {
    note(settings.log, "WARNING: the refinement did not end and was cut short; see the quality");
  }
  set_regions(body, settings, filling, inclusions);
  body.nodes = std::move(filling.nodes);
  body.tetrahedra = std::move(filling.tetrahedra);

  curve_skin(body, nested, settings);

  const Quality quality = measure_quality(body.nodes, body.tetrahedra);
  check_volumes(quality, nested.boundary, where);
  note(settings.log,
       text("body: ", body.nodes.size(), " nodes, ", body.tetrahedra.size(), " tetrahedra, ",
            body.fixed_nodes.size(), " nodes held, ",
            body.foundation.empty() ? std::string()
                                    : text(body.foundation.size(), " facets on springs, "),
            std::count(body.response.is_site.begin(), body.response.is_site.end(), 1), " sites"));
  note(settings.log, "quality: " + summary(quality));
  return body;
}

}  // namespace palpate::mesher
