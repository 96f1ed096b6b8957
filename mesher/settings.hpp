// SPDX-License-Identifier: AGPL-3.0-or-later
// What the mesher is asked to make.
#pragma once

#include <concepts>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "format/vec3.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/repair/repair_settings.hpp"

namespace palpate::mesher {

/// Receives the faces of a file that a repair kept, and the surface that it made of them.
using OnRepair = std::function<void(const Surface& kept, const Surface& repaired)>;

/// A triangulated surface on disk (OFF, OBJ, PLY, STL, VTP, VTK), the length of its unit, and how
/// its faults are repaired.
struct SurfaceFile {
  std::filesystem::path path;
  double unit = 1.0;        ///< m per unit of the file
  std::string region_name;  ///< material region of its interior
  RepairSettings repair{};
  bool is_void = false;  ///< an inclusion that is empty: a vessel or a cavity
  bool smooth = false;   ///< of the outer surface: the facets stand for a smooth surface, `smooth`
};

/// A layer below the skin of the body, or below the layer before it.
struct LayerSettings {
  double thickness = 0;     ///< m
  std::string region_name;  ///< material region of the layer
};

/// The region of the body that the elements of a group of a mesh file belong to.
struct GroupRegion {
  std::string group;  ///< physical group, element set or value of a cell array
  std::string region;
};

/// A mesh of tetrahedra on disk, used as it is: Gmsh .msh, VTK .vtu and .vtk, Abaqus and CalculiX
/// .inp, FEBio .feb, TetGen .node and .ele.
struct VolumeMeshFile {
  std::filesystem::path path;
  double unit = 1.0;                 ///< m per unit of the file
  std::string region_array;          ///< VTK: cell array of the regions; empty: found by its name
  std::vector<GroupRegion> regions;  ///< groups that are not listed are regions of their own name
};

/// The region of the voxels of a label.
struct ImageLabel {
  int value = 1;
  std::string region;
};

/// A segmentation on disk (NIfTI, NRRD). Labels that are not listed are no part of the body.
struct ImageFile {
  std::filesystem::path path;
  double unit = 0;  ///< m per unit of the header; 0: that which the header states
  std::vector<ImageLabel> labels;
};

/// Contains the nodes on the side of the plane to which `normal` points.
struct PlaneSupport {
  Vec3 point{};   ///< m
  Vec3 normal{};  ///< unit
};
/// Contains the nodes inside an axis-aligned box.
struct BoxSupport {
  Vec3 low{}, high{};  ///< m
};
/// Contains the nodes inside a sphere.
struct SphereSupport {
  Vec3 centre{};      ///< m
  double radius = 0;  ///< m
};
/// Contains the nodes inside a second closed surface (a bone) or nearer to it than `distance`.
struct SurfaceSupport {
  SurfaceFile surface;
  double distance = 0;  ///< m
};
/// Contains the nodes on the faces of the skin that have this name in its file, or the nodes of the
/// set of this name of a volume mesh, or of the region of this name of an image.
struct LabelSupport {
  std::string label;
};
using Support = std::variant<PlaneSupport, BoxSupport, SphereSupport, SurfaceSupport, LabelSupport>;

/// The nodes that a shape contains, or all others.
struct Zone {
  Support shape;
  bool inverted = false;

  Zone() = default;
  template <class Shape>
  requires std::constructible_from<Support, Shape> Zone(Shape one, bool everything_but = false)
      : shape(std::move(one)), inverted(everything_but) {}
};

/// An elastic foundation under the boundary facets whose nodes all lie inside `where`.
struct Springs {
  Zone where;
  double normal_stiffness = 0;      ///< N/m^3, along the normal of the facet
  double tangential_stiffness = 0;  ///< N/m^3, across it
};

/// How the tetrahedra are made.
enum class MeshMethod {
  Auto,       ///< isotropic remeshing, or Delaunay refinement where that fails
  Isotropic,  ///< keeps sharp edges; boundary facets nest in the patches
  Delaunay    ///< meshes detail finer than a patch; rounds sharp edges
};

/// Along what tools are pressed.
enum class PressDirections {
  Normal,  ///< the mean normal of the facets around a vertex
  Sliding  ///< that, turned at rims and lobes so that slides have a bound down to the depth
};

struct Settings {
  std::string name;
  SurfaceFile surface{{}, 1.0, "matrix"};  ///< the outer skin
  std::vector<SurfaceFile> inclusions;     ///< closed surfaces; where they overlap, the last wins
  std::vector<LayerSettings> layers;       ///< outermost first; inclusions cut into them
  VolumeMeshFile volume_mesh;              ///< instead of a surface, where it has a path
  ImageFile image;                         ///< instead of a surface, where it has a path
  std::vector<Zone> supports;              ///< surface nodes inside any of them are fixed
  std::vector<Springs> foundation;         ///< stiffnesses add where foundations overlap
  MeshMethod method = MeshMethod::Auto;
  std::vector<Zone> press;           ///< sites lie inside one of them; empty: everywhere
  bool all_nodes_are_sites = false;  ///< of a volume mesh, whatever the patch_spacing
  double patch_spacing = 0.010;      ///< m, edge length of the response surface
  double element_size = 0.005;       ///< m, edge length of the boundary facets
  /// m, size that the skin is prepared for: its smooth facets and the outlines of supports. Meshes
  /// that are compared share it, so that they have the same response vertices. 0: element_size.
  double skin_size = 0;
  double interior_coarsening = 1.5;  ///< target of the largest interior edge over element_size
  double support_coarsening = 1;     ///< largest edge at supports over element_size
  double feature_angle = std::numbers::pi / 4;  ///< rad; sharper edges of the input stay sharp
  PressDirections directions = PressDirections::Normal;
  bool curved_facets = true;   ///< writes Body::curved_edges; without, facets are flat
  double tool_radius = 0.005;  ///< m, smallest distance of sites from supports
  double depth = 0;            ///< m, of the planned indentation; 0 skips the check
  double lateral_travel = 0;   ///< m, of the planned drags; 0 skips the check
  std::function<void(std::string_view)> log;  ///< receives one line for each step; may be empty
  OnRepair on_repair;  ///< called where the outer surface was repaired; may be empty

  double size_of_skin() const { return skin_size > 0 ? skin_size : element_size; }

  /// The file that the body is made of.
  const std::filesystem::path& source() const {
    if (!image.path.empty()) return image.path;
    return volume_mesh.path.empty() ? surface.path : volume_mesh.path;
  }
};

}  // namespace palpate::mesher
