// SPDX-License-Identifier: AGPL-3.0-or-later
// The supports of a body: fixed nodes and the elastic foundation.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "format/body.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/settings.hpp"

namespace palpate::mesher {

/// One entry for each point of a surface: 1 where it is marked.
using Marks = std::vector<std::uint8_t>;

bool all_marked(const Triangle& triangle, const Marks& marks);

/// Marks also what `more` marks.
void add_marks(Marks& marks, const Marks& more);

/// Nodes on the border of a support are inside it whatever their rounding: this part of the size of
/// the skin.
inline constexpr double kSupportTolerance = 1e-3;

/// For each entry of Surface::known_names, whether it has the label.
/// @throws Error(Configuration) when none has; `where` names the file.
std::vector<bool> entries_with(const std::string& label, const Surface& skin,
                               const std::string& where);

/// Whether the shape contains the point; `tolerance` (m) widens it.
bool contains(const PlaneSupport& plane, const Vec3& point, double tolerance);
bool contains(const BoxSupport& box, const Vec3& point, double tolerance);
bool contains(const SphereSupport& sphere, const Vec3& point, double tolerance);

/// Whether the point lies inside the closed surface or within `distance` (m) of it.
bool is_near(const SurfaceQuery& surface, const Vec3& point, double distance);

using NodeSets = std::map<std::string, std::vector<std::int32_t>>;

/// What a LabelSupport asks for.
struct Labels {
  const Surface& skin;                  ///< the surface as read, with the names of its faces
  const NodeSets* node_sets = nullptr;  ///< of a volume mesh, in the place of the skin
};

/// Writes Body::fixed_nodes: the points of `boundary`, which are the first nodes, inside a support.
/// @return the fixed nodes, marked
/// @throws Error(Configuration) when no face or set has the name of a LabelSupport.
Marks fix_nodes(Body& body, const Settings& settings, const Labels& labels,
                const Surface& boundary);

/// Settings::support_coarsening near triangles of the skin whose corners all lie inside the fixed
/// supports or inside one foundation, 1 elsewhere; empty where it is 1.
/// @throws Error as fix_nodes.
std::function<double(const Vec3&)> coarsening_at_supports(const Settings& settings,
                                                          const Surface& skin);

/// Takes the sites outside every press zone from Body::response; without zones all stay.
/// @throws Error as fix_nodes.
void keep_sites_in_zones(Body& body, const Settings& settings, const Labels& labels,
                         const Surface& boundary);

/// Writes Body::foundation.
/// @return the nodes of the facets on springs, marked
/// @throws Error(Geometry) when springs are given and no facet lies inside their supports.
Marks set_foundation(Body& body, const Settings& settings, const Labels& labels,
                     const Surface& boundary);

/// @throws Error(Geometry) when fixed nodes and springs leave a rigid motion free.
void check_supports(const Body& body, const Settings& settings, const Surface& boundary);

}  // namespace palpate::mesher
