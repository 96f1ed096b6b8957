// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/support/supports.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/read_surface.hpp"
#include "mesher/support/rigid_motion.hpp"

namespace palpate::mesher {
namespace {

/// The set of this name. @throws Error(Configuration) with the names that there are.
const std::vector<std::int32_t>& set_named(const std::string& label, const NodeSets& sets,
                                           const std::string& where) {
  if (const auto found = sets.find(label); found != sets.end()) return found->second;
  std::string list;
  for (const auto& [name, nodes] : sets) list += (list.empty() ? "'" : ", '") + name + "'";
  refuse(where, text("the mesh has no set '", label, "', which a support or press zone asks for"),
         text("use one of ", list));
}

/// The outlines of round shapes have chords of up to a quarter of the size of the skin: where the
/// outline is concave they lie outside, by as much of kSupportTolerance down to radii of that size.
constexpr double kRoundTolerance = 10;

/// Marks the boundary points inside a support.
struct MarkInside {
  const Settings& settings;
  const Labels& labels;
  const Surface& boundary;
  double tolerance = kSupportTolerance * settings.size_of_skin();  ///< by which the shape is wider
  bool inverted = false;

  Marks marks_of(const Zone& zone) const {
    if (!zone.inverted) return std::visit(*this, zone.shape);
    return std::visit(MarkInside{settings, labels, boundary, -tolerance, true}, zone.shape);
  }

  template <typename Shape>
  Marks operator()(const Shape& shape) const {
    constexpr double times = std::is_same_v<Shape, SphereSupport> ? kRoundTolerance : 1;
    return mark([&](const Vec3& x) { return contains(shape, x, times * tolerance) != inverted; });
  }

  Marks operator()(const SurfaceSupport& near) const {
    const SurfaceQuery surface(read_surface(near.surface, settings.log));
    const double reach = near.distance + kRoundTolerance * tolerance;
    return mark([&](const Vec3& x) { return is_near(surface, x, reach) != inverted; });
  }

  /// A point within the tolerance of a named face has that face, or one that shares a corner with
  /// it, as its nearest.
  Marks operator()(const LabelSupport& support) const {
    if (labels.node_sets != nullptr) return mark_set(support);
    const Surface& skin = labels.skin;
    const std::vector<bool> has_label =
        entries_with(support.label, skin, settings.source().string());
    const SurfaceQuery query(skin);
    const auto around = incident_triangles(skin.points.size(), skin.triangles);
    const auto lies_on = [&](const Vec3& x, std::int32_t t) {
      const Triangle& triangle = skin.triangles[to_index(t)];
      const auto corner = [&](std::size_t k) { return skin.points[to_index(triangle[k])]; };
      return has_label[skin.names[to_index(t)]] != inverted &&
             distance_to_triangle(x, corner(0), corner(1), corner(2)) <= std::abs(tolerance);
    };
    return mark([&](const Vec3& x) {
      const Triangle& nearest = skin.triangles[to_index(query.closest(x).triangle)];
      return std::any_of(nearest.begin(), nearest.end(), [&](std::int32_t corner) {
        const auto& fan = around[to_index(corner)];
        return std::any_of(fan.begin(), fan.end(), [&](std::int32_t t) { return lies_on(x, t); });
      });
    });
  }

 private:
  /// The points of the boundary are the first nodes.
  Marks mark_set(const LabelSupport& support) const {
    Marks marks(boundary.points.size(), inverted ? 1 : 0);
    for (const std::int32_t node :
         set_named(support.label, *labels.node_sets, settings.source().string()))
      if (to_index(node) < marks.size()) marks[to_index(node)] = inverted ? 0 : 1;
    return marks;
  }

  template <typename Predicate>
  Marks mark(const Predicate& is_inside) const {
    Marks marks;
    for (const Vec3& x : boundary.points) marks.push_back(is_inside(x) ? 1 : 0);
    return marks;
  }
};

std::vector<SupportedPoint> supported_points(const Body& body, const Surface& boundary) {
  std::vector<SupportedPoint> points;
  for (const std::int32_t node : body.fixed_nodes)
    points.push_back({boundary.points[to_index(node)]});
  for (const SprungFacet& sprung : body.foundation) {
    const Triangle& facet = boundary.triangles[to_index(sprung.facet)];
    const double stiffest = std::max(sprung.normal_stiffness, sprung.tangential_stiffness);
    for (const std::int32_t node : facet)
      points.push_back({boundary.points[to_index(node)], unit(area_vector(boundary.points, facet)),
                        sprung.normal_stiffness / stiffest,
                        sprung.tangential_stiffness / stiffest});
  }
  return points;
}

}  // namespace

std::vector<bool> entries_with(const std::string& label, const Surface& skin,
                               const std::string& where) {
  std::vector<bool> has_label;
  std::set<std::string> all;
  bool found = false;
  for (const Names& names : skin.known_names) {
    all.insert(names.begin(), names.end());
    has_label.push_back(std::find(names.begin(), names.end(), label) != names.end());
    found = found || has_label.back();
  }
  if (found) return has_label;
  constexpr std::size_t kListed = 20;  // a painted surface may have thousands of colours
  std::string list;
  std::size_t listed = 0;
  for (const std::string& name : all)
    if (listed++ < kListed) list += (list.empty() ? "" : ", ") + name;
  if (all.size() > kListed) list += text(" or ", all.size() - kListed, " more");
  throw Error(ErrorKind::Configuration, where,
              text("no face has the name '", label, "', which is asked for"),
              all.empty()
                  ? "name faces by 'g', 'o' or 'usemtl' in an OBJ file, by solids in an STL "
                    "file of text, by colours in a PLY file, or by an integer cell array in a VTK "
                    "file"
                  : text("use one of ", list));
}

bool all_marked(const Triangle& triangle, const Marks& marks) {
  return std::all_of(triangle.begin(), triangle.end(),
                     [&](std::int32_t v) { return marks[to_index(v)] != 0; });
}

void add_marks(Marks& marks, const Marks& more) {
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i] |= more[i];
}

bool contains(const PlaneSupport& plane, const Vec3& point, double tolerance) {
  return dot(point - plane.point, unit(plane.normal)) >= -tolerance;
}

bool contains(const BoxSupport& box, const Vec3& point, double tolerance) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (point[k] < box.low[k] - tolerance || point[k] > box.high[k] + tolerance) return false;
  }
  return true;
}

bool contains(const SphereSupport& sphere, const Vec3& point, double tolerance) {
  return norm(point - sphere.centre) <= sphere.radius + tolerance;
}

bool is_near(const SurfaceQuery& surface, const Vec3& point, double distance) {
  return norm(surface.closest(point).point - point) <= distance || surface.contains(point);
}

Marks fix_nodes(Body& body, const Settings& settings, const Labels& labels,
                const Surface& boundary) {
  Marks fixed(boundary.points.size(), 0);
  const MarkInside inside{settings, labels, boundary};
  for (const Zone& support : settings.supports) add_marks(fixed, inside.marks_of(support));
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i] != 0) body.fixed_nodes.push_back(static_cast<std::int32_t>(i));
  return fixed;
}

std::function<double(const Vec3&)> coarsening_at_supports(const Settings& settings,
                                                          const Surface& skin) {
  if (settings.support_coarsening == 1) return {};
  Marks fixed(skin.points.size(), 0);
  const Labels labels{skin};
  const MarkInside inside{settings, labels, skin};
  for (const Zone& support : settings.supports) add_marks(fixed, inside.marks_of(support));
  std::vector<bool> is_supported;
  for (const Triangle& t : skin.triangles) is_supported.push_back(all_marked(t, fixed));
  for (const Springs& springs : settings.foundation) {
    const Marks sprung = inside.marks_of(springs.where);
    for (std::size_t t = 0; t < skin.triangles.size(); ++t)
      if (all_marked(skin.triangles[t], sprung)) is_supported[t] = true;
  }
  const auto query = std::make_shared<SurfaceQuery>(skin);
  return [=, coarsening = settings.support_coarsening](const Vec3& x) {
    return is_supported[to_index(query->closest(x).triangle)] ? coarsening : 1.0;
  };
}

void keep_sites_in_zones(Body& body, const Settings& settings, const Labels& labels,
                         const Surface& boundary) {
  if (settings.press.empty()) return;
  Marks pressed(boundary.points.size(), 0);
  const MarkInside inside{settings, labels, boundary};
  for (const Zone& zone : settings.press) add_marks(pressed, inside.marks_of(zone));
  std::size_t taken = 0;
  for (std::size_t v = 0; v < body.response.is_site.size(); ++v) {
    if (body.response.is_site[v] == 0 || pressed[to_index(body.response.node[v])] != 0) continue;
    body.response.is_site[v] = 0;
    ++taken;
  }
  note(settings.log, text("press zones: ", counted(taken, "vertex", "vertices"), " outside them ",
                          taken == 1 ? "is no site" : "are no sites"));
}

Marks set_foundation(Body& body, const Settings& settings, const Labels& labels,
                     const Surface& boundary) {
  Marks on_springs(boundary.points.size(), 0);
  std::map<std::int32_t, SprungFacet> facets;
  for (const Springs& springs : settings.foundation) {
    const Marks inside = MarkInside{settings, labels, boundary}.marks_of(springs.where);
    for (std::size_t f = 0; f < boundary.triangles.size(); ++f) {
      if (!all_marked(boundary.triangles[f], inside)) continue;
      const auto number = static_cast<std::int32_t>(f);
      SprungFacet& facet = facets[number];
      facet.facet = number;
      facet.normal_stiffness += springs.normal_stiffness;
      facet.tangential_stiffness += springs.tangential_stiffness;
      for (const std::int32_t node : boundary.triangles[f]) on_springs[to_index(node)] = 1;
    }
  }
  for (const auto& [number, facet] : facets) body.foundation.push_back(facet);
  if (!settings.foundation.empty() && facets.empty()) {
    throw Error(ErrorKind::Geometry, settings.source().string(),
                "the supports with springs contain no facet",
                text("place them on the body, which spans ", extent_of(boundary.points)));
  }
  return on_springs;
}

void check_supports(const Body& body, const Settings& settings, const Surface& boundary) {
  if (prevent_rigid_motion(supported_points(body, boundary))) return;
  const std::string springs =
      body.foundation.empty()
          ? std::string()
          : text(" and ", counted(body.foundation.size(), "facet"), " on springs");
  throw Error(ErrorKind::Geometry, settings.source().string(),
              text("rigid-body motion is not constrained by the supports, ",
                   body.fixed_nodes.size(), " fixed nodes of ", boundary.points.size(), springs),
              text(springs.empty() ? "place a support on the body, which spans "
                                   : "give tangential_stiffness, or fix a part of the body, which "
                                     "spans ",
                   extent_of(boundary.points)));
}

}  // namespace palpate::mesher
