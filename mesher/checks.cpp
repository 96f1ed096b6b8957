// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/checks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/geometry/thickness.hpp"

namespace palpate::mesher {
namespace {

constexpr double kDeepestFraction = 0.8;  // of the thickness under the tool
constexpr double kFewestPatches = 3;      // along the largest extent of the body

// Smallest volume of an element relative to a regular one with the same longest edge.
constexpr double kSmallestVolume = 1e-9;

[[noreturn]] void refuse_setting(const std::string& problem, const std::string& remedy) {
  throw Error(ErrorKind::Configuration, "mesh", problem, remedy);
}

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

bool not_negative(double value) {
  return std::isfinite(value) && value >= 0;
}

void check_lengths(const Settings& s) {
  if (!positive(s.patch_spacing) || !positive(s.element_size)) {
    refuse_setting("patch_spacing and element_size must be positive lengths", "correct the case");
  }
  if (!std::isfinite(s.interior_coarsening) || s.interior_coarsening < 1) {
    refuse_setting(text("interior_coarsening is ", s.interior_coarsening, ", below 1"),
                   "give 1 for a uniform mesh or more for a coarser interior");
  }
  if (!std::isfinite(s.support_coarsening) || s.support_coarsening < 1) {
    refuse_setting(text("support_coarsening is ", s.support_coarsening, ", below 1"),
                   "give 1 for elements as small as elsewhere or more for larger ones");
  }
  if (!(s.feature_angle > 0 && s.feature_angle <= std::numbers::pi)) {
    refuse_setting(text("feature_angle is ", s.feature_angle, " rad"), "give 0 .. pi");
  }
  if (!positive(s.tool_radius) || !not_negative(s.depth) || !not_negative(s.lateral_travel)) {
    refuse_setting("tool_radius must be positive, depth and lateral_travel not negative",
                   "correct the case");
  }
}

/// @param file a SurfaceFile or a VolumeMeshFile
template <class File>
void check_unit(const File& file) {
  if (positive(file.unit)) return;
  refuse_setting(text("the unit of ", file.path.string(), " is ", file.unit, " m"),
                 "give a positive length, 0.001 for millimetres");
}

void check_springs(const Springs& springs) {
  if (not_negative(springs.normal_stiffness) && not_negative(springs.tangential_stiffness) &&
      springs.normal_stiffness + springs.tangential_stiffness != 0) {
    return;
  }
  refuse_setting(text("springs of ", springs.normal_stiffness, " and ",
                      springs.tangential_stiffness, " N/m^3"),
                 "give stiffnesses that are not negative, one of them positive");
}

void check_support(const Support& support) {
  const auto* plane = std::get_if<PlaneSupport>(&support);
  if (plane && !positive(norm(plane->normal))) {
    refuse_setting("the normal of a plane support has no direction", "correct the case");
  }
  const auto* near = std::get_if<SurfaceSupport>(&support);
  if (near == nullptr) return;
  check_unit(near->surface);
  if (!not_negative(near->distance)) {
    refuse_setting(text("the distance of a surface support is ", near->distance, " m"),
                   "give 0 or more");
  }
}

double largest_extent(const Surface& skin) {
  const Bounds box = bounds(skin.points);
  const Vec3 span = box.high - box.low;
  return std::max({span[0], span[1], span[2]});
}

void check_spacing(const Settings& settings, double largest) {
  if (kFewestPatches * settings.patch_spacing <= largest) return;
  throw Error(ErrorKind::Configuration, settings.source().string(),
              text("the largest extent of the body is ", millimetres(largest),
                   ", too little for patches of ", millimetres(settings.patch_spacing)),
              text("check the unit of the surface, or reduce patch_spacing below ",
                   millimetres(largest / kFewestPatches)));
}

void check_lateral_travel(const Settings& settings, double largest) {
  if (settings.lateral_travel <= largest) return;
  throw Error(ErrorKind::Geometry, settings.source().string(),
              text("a lateral travel of ", millimetres(settings.lateral_travel),
                   " is longer than the body, ", millimetres(largest)),
              "reduce lateral_travel to what a tool slides before it slips, or check the unit of "
              "the surface");
}

/// Equilateral triangles of this edge on the surface.
double facets_of(const Surface& skin, double edge) {
  return area(skin) / (0.43 * edge * edge);
}

double interior_nodes_of(const Settings& settings, const Surface& skin) {
  return 1.5 * signed_volume(skin) /
         std::pow(settings.interior_coarsening * settings.element_size, 3);
}

void check_counts(const Settings& settings, const Surface& skin) {
  const double h = settings.element_size;
  const double facets = facets_of(skin, h), interior = interior_nodes_of(settings, skin);
  if (facets > kMostNodes || interior > kMostNodes) {
    throw Error(ErrorKind::Configuration, settings.source().string(),
                text("an element_size of ", millimetres(h), " needs about ", facets,
                     " boundary facets and ", interior, " interior nodes, more than ", kMostNodes),
                "increase element_size or interior_coarsening, or check the unit of the surface");
  }
}

}  // namespace

void check_settings(const Settings& settings) {
  for (const LayerSettings& layer : settings.layers) {
    if (!positive(layer.thickness)) {
      refuse_setting(text("a layer of ", layer.thickness, " m"), "give a positive thickness");
    }
  }
  check_lengths(settings);
  for (const Springs& springs : settings.foundation) check_springs(springs);
  for (const Zone& zone : settings.supports) check_support(zone.shape);
  for (const Zone& zone : settings.press) check_support(zone.shape);
  for (const Springs& springs : settings.foundation) check_support(springs.where.shape);
  check_unit(settings.surface);
  check_unit(settings.volume_mesh);
  for (const SurfaceFile& inclusion : settings.inclusions) check_unit(inclusion);
}

void check_sizes(const Settings& settings, const Surface& skin) {
  const double largest = largest_extent(skin);
  check_spacing(settings, largest);
  check_lateral_travel(settings, largest);
  if (settings.volume_mesh.path.empty()) check_counts(settings, skin);
}

double nodes_of(const Settings& settings, const Surface& skin) {
  return facets_of(skin, settings.element_size) / 2 + interior_nodes_of(settings, skin);
}

void exclude_thin_sites(Body& body, const Settings& settings, const Surface& boundary) {
  if (settings.depth <= 0) return;
  const auto thickness = thickness_under_tool(boundary, body.response.inward, settings.tool_radius);
  std::vector<std::size_t> sites, thin;
  for (std::size_t v = 0; v < thickness.size(); ++v) {
    if (body.response.is_site[v] == 0) continue;
    sites.push_back(v);
    if (settings.depth > kDeepestFraction * thickness[v]) thin.push_back(v);
  }
  if (sites.empty()) return;
  const auto thinner = [&](std::size_t a, std::size_t b) { return thickness[a] < thickness[b]; };
  std::sort(sites.begin(), sites.end(), thinner);
  const std::size_t thinnest = sites.front();
  const std::string at_the_thinnest = text(millimetres(std::max(thickness[thinnest], 0.0)), " at ",
                                           position_text(boundary.points[thinnest]));
  if (2 * thin.size() > sites.size()) {
    const double typical = thickness[sites[sites.size() / 2]];
    refuse_geometry(settings.source().string(),
                    text("a depth of ", millimetres(settings.depth), " is more than ",
                         kDeepestFraction, " of the thickness at ", thin.size(), " of ",
                         counted(sites.size(), "site"), ": the thickness is ", at_the_thinnest,
                         " and ", millimetres(typical), " in the median"),
                    text("reduce the depth below ", millimetres(kDeepestFraction * typical),
                         ", or check the unit of the surface"));
  }
  for (const std::size_t v : thin) body.response.is_site[v] = 0;
  if (thin.empty()) {
    note(settings.log, text("depth: ", millimetres(settings.depth), " of at least ",
                            millimetres(thickness[thinnest]), " under every site"));
    return;
  }
  warn(settings.log,
       text(thin.size(), " of ", counted(sites.size(), "site"), thin.size() == 1 ? " is" : " are",
            " too thin for the depth of ", millimetres(settings.depth), " and ",
            thin.size() == 1 ? "becomes a hole" : "become holes", ": the thickness is ",
            at_the_thinnest, "; a smaller depth recovers them"));
}

void check_elements(const VolumeMesh& mesh, const std::string& where) {
  for (const Tetrahedron& element : mesh.tetrahedra) {
    const auto corner = [&](std::size_t k) { return mesh.nodes[to_index(element[k])]; };
    double longest = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) longest = std::max(longest, norm(corner(i) - corner(j)));
    const double regular = longest * longest * longest / (6 * std::numbers::sqrt2);
    const double fraction = volume(mesh.nodes, element) / regular;
    if (fraction > kSmallestVolume) continue;
    const Vec3 centroid = 0.25 * (corner(0) + corner(1) + corner(2) + corner(3));
    throw Error(
        ErrorKind::Geometry, where,
        text("a tetrahedron near ", position_text(centroid), " is degenerate: its volume is ",
             fraction, " of that of a regular one with the same longest edge, ",
             millimetres(longest)),
        "change patch_spacing or element_size a little, or smooth the surface there");
  }
}

void check_filled(const VolumeMesh& mesh, const Surface& boundary, const std::string& where) {
  const double filled = measure_quality(mesh.nodes, mesh.tetrahedra).volume;
  const double enclosed = signed_volume(boundary);
  if (!(std::abs(filled - enclosed) <= 1e-9 * enclosed)) {
    throw Error(ErrorKind::Internal, where,
                text("the tetrahedra fill ", filled, " m^3 of the ", enclosed,
                     " m^3 enclosed by the boundary"),
                "change element_size or patch_spacing a little and report the case");
  }
}

}  // namespace palpate::mesher
