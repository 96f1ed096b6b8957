// SPDX-License-Identifier: AGPL-3.0-or-later
// Surface file(s) -> body. CGAL and TetGen stay inside the .cpp files of this folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "format/body.hpp"

namespace palpate::mesher {

/// A closed triangulated surface on disk (OFF, OBJ, PLY, STL) and the length of its unit.
struct SurfaceFile {
  std::filesystem::path path;
  double unit = 1.0;        ///< m per unit of the file
  std::string region_name;  ///< material region of its interior
};

/// Nodes on the side of the plane to which `normal` points are held.
struct PlaneSupport {
  Vec3 point{};   ///< m
  Vec3 normal{};  ///< unit
};
struct BoxSupport {
  Vec3 low{}, high{};  ///< m
};
struct SphereSupport {
  Vec3 centre{};
  double radius = 0;  ///< m
};
/// Nodes inside a second closed surface (a bone) or nearer to it than `distance`.
struct SurfaceSupport {
  SurfaceFile surface;
  double distance = 0;  ///< m
};
/// Nodes on the faces of the skin that bear a name in its file.
struct LabelSupport {
  std::string label;
};
using Support = std::variant<PlaneSupport, BoxSupport, SphereSupport, SurfaceSupport, LabelSupport>;

/// Boundary facets whose nodes all lie inside `where` rest on springs, N/m^3, along and across
/// their normals.
struct Springs {
  Support where;
  double normal_stiffness = 0, tangential_stiffness = 0;
};

struct Settings {
  std::string name;
  SurfaceFile surface;                  ///< the outer skin
  std::vector<SurfaceFile> inclusions;  ///< closed surfaces strictly inside it, disjoint
  std::vector<Support> supports;        ///< surface nodes inside any of them are fixed
  std::vector<Springs> foundation;      ///< where several overlap, they add up
  double patch_spacing = 0.010;         ///< m, edge length of the response surface
  double element_size = 0.005;          ///< m, edge length of the boundary facets
  double interior_growth = 1.5;         ///< largest interior edge over element_size (aimed at)
  double feature_angle = 45;            ///< degrees; sharper edges of the input are kept
  bool curved_facets = true;            ///< Body::curved_edges, else the tool meets flat facets
  double tool_radius = 0.005;           ///< m, keeps sites clear of supports; depth check
  double depth = 0;                     ///< m, of the planned indentation; 0 skips the check
  double lateral_travel = 0;            ///< m, of the planned drags; 0 skips the check
  std::function<void(std::string_view)> log;  ///< one line a step, may be empty
};

/// Check, remesh and fill. The response surface has edges near patch_spacing; the boundary facets
/// are its triangles, each divided into n x n with n = round(patch_spacing / element_size), the new
/// vertices put back on the input surface, so that the two surfaces are nested: the facets of
/// response triangle m are Body::boundary[m n^2 .. (m+1) n^2), and response vertex v is node v.
/// Equal settings and files give equal bodies. Nodes within element_size/1000 of a support are
/// held. Response vertices within tool_radius of a node that is held or on springs are no sites.
/// Response vertices where no direction can be interpolated (sharper than the patches resolve) are
/// no sites; the log counts them. Provenance is left to the caller.
/// @throws Error(Geometry) for a surface that is missing, empty, not closed, not orientable,
///   self-intersecting, in several parts, has non-finite coordinates, an implausible size for its
///   unit (the largest dimension must lie in 1 mm .. 10 m), an inclusion outside the skin, supports
///   that hold nothing or everything, detail finer than the patches, a depth of more than 0.8 of
///   the thickness under a site, or a drag farther than across the body.
/// @throws Error(Configuration) for settings out of range.
Body mesh(const Settings& settings);

}  // namespace palpate::mesher
