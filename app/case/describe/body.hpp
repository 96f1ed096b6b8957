// SPDX-License-Identifier: AGPL-3.0-or-later
// The sections that say what the body is and how it is meshed.
#pragma once

#include <numbers>
#include <string>
#include <string_view>

#include "app/case/describe/key.hpp"
#include "mesher/settings.hpp"

namespace palpate::app {

template <class V>
void describe_repair(V& v, mesher::RepairSettings& s) {
  describe_choice(
      v, s.mode,
      {"repair",
       "faults of the surface: `auto` repairs them, by an alpha wrap where local repairs do not "
       "suffice, `none` refuses them, `wrap` replaces the surface by its alpha wrap"},
      kRepairModes);
  describe_choice(
      v, s.largest_part,
      {"parts",
       "separate parts: `one` refuses several, `largest` keeps the one with the largest "
       "area"},
      kParts);
  v.number(s.max_hole, {"max_hole",
                        "holes of a larger diameter, over the extent of the surface, are filled "
                        "with a warning, unless they are flat cuts",
                        kOptional,
                        {.low = 0, .high = 1}});
  v.number(s.max_change, {"max_change",
                          "largest distance that local repairs may move the surface, over its "
                          "extent; beyond it, the alpha wrap replaces the surface",
                          kOptional,
                          {.low = 0, .high = 1}});
}

template <class V>
void describe_surface(V& v, mesher::SurfaceFile& s) {
  describe_path(
      v, s.path,
      {"file", "surface (OFF, OBJ, PLY, STL, VTP or VTK), relative to the case", kRequired});
  describe_length_unit(v, s.unit,
                       {"unit", "length unit of the coordinates in the file", kRequired});
  v.text(s.region_name, {"region", "name of the material region inside the surface"});
  v.flag(s.smooth,
         {"smooth",
          "`true`: the body is bounded by a smooth surface through the points of the file, not by "
          "its facets; edges sharper than `mesh.feature_angle` stay"});
  describe_repair(v, s.repair);
}

template <class V>
void describe_inclusion(V& v, mesher::SurfaceFile& s) {
  describe_path(v, s.path,
                {"file",
                 "closed surface; it may touch, cross or contain others: where they overlap, "
                 "the last one counts, and what lies outside the body is cut off",
                 kRequired});
  describe_length_unit(v, s.unit,
                       {"unit", "length unit of the coordinates in the file", kRequired});
  v.text(s.region_name,
         {"region", "name of the material region inside the surface, unless `void`"});
  v.flag(s.is_void, {"void", "`true`: the inside is empty, as that of a vessel"});
  describe_repair(v, s.repair);
}

template <class V>
void describe_layer(V& v, mesher::LayerSettings& s) {
  v.quantity(s.thickness, Dimension::Length,
             {"thickness", "distance between the two walls of the layer", kRequired, kPositive});
  v.text(s.region_name, {"region", "name of the material region of the layer", kRequired});
}

template <class V>
void describe_volume_mesh(V& v, mesher::VolumeMeshFile& s) {
  describe_path(v, s.path,
                {"file",
                 "tetrahedra, linear or quadratic (Gmsh .msh, MEDIT .mesh, VTK .vtu or .vtk, "
                 "Abaqus or CalculiX "
                 ".inp, FEBio .feb, TetGen .node and .ele), relative to the case",
                 kRequired});
  describe_length_unit(v, s.unit,
                       {"unit", "length unit of the coordinates in the file", kRequired});
  v.text(s.region_array,
         {"region_array",
          "VTK: integer cell array whose values are the regions; empty: the only one, or the one "
          "with a usual name"});
}

template <class V>
void describe_image(V& v, mesher::ImageFile& s) {
  describe_path(
      v, s.path,
      {"file", "segmentation (NIfTI .nii, .nii.gz, or NRRD), relative to the case", kRequired});
  constexpr std::string_view of_header = "header";
  Choices choices = unit_symbols(Dimension::Length);
  choices.insert(choices.begin(), of_header);
  std::string symbol(of_header);
  for (const Unit& unit : units_of(Dimension::Length))
    if (unit.si == s.unit) symbol = unit.symbol;
  v.text(symbol, {"unit", "length unit of the header; `header`: that which it states"}, choices);
  s.unit = 0;
  for (const Unit& unit : units_of(Dimension::Length))
    if (unit.symbol == symbol) s.unit = unit.si;
}

template <class V>
void describe_image_label(V& v, mesher::ImageLabel& s) {
  v.integer(s.value, {"value", "value of the voxels", kRequired, {.low = 1, .high = 2147483647}});
  v.text(s.region, {"region", "name of the region of these voxels", kRequired});
}

template <class V>
void describe_mesh_region(V& v, mesher::GroupRegion& s) {
  v.text(s.group, {"group", "physical group, element set or, for VTK, `array=value`", kRequired});
  v.text(s.region, {"region", "name of the region of its elements", kRequired});
}

template <class V>
void describe_mesh(V& v, mesher::Settings& s) {
  describe_choice(
      v, s.method,
      {"method",
       "`isotropic` remeshes the skin and keeps its sharp edges; `delaunay` also meshes detail "
       "finer than a patch and rounds sharp edges; `auto` takes the first that makes a sound mesh"},
      kMeshMethods);
  v.quantity_or_auto(
      s.patch_spacing, Dimension::Length,
      {"patch_spacing",
       "edge length of the response surface; `auto`: a fifteenth of the diagonal of the box around "
       "the body",
       kOptional, kPositive});
  v.quantity_or_auto(
      s.element_size, Dimension::Length,
      {"element_size", "edge length of the boundary facets; `auto`: half of `patch_spacing`",
       kOptional, kPositive});
  v.number(s.interior_coarsening, {"interior_coarsening",
                                   "target ratio of the largest interior edge to `element_size`",
                                   kOptional,
                                   {.low = 1}});
  v.number(s.support_coarsening,
           {"support_coarsening",
            "target ratio of the edges at supports to `element_size`; above 1, Delaunay "
            "refinement makes the mesh",
            kOptional,
            {.low = 1}});
  v.quantity(s.feature_angle, Dimension::Angle,
             {"feature_angle",
              "edges of the surface with a larger dihedral deviation are preserved",
              kOptional,
              {.low = 0, .high = std::numbers::pi, .low_open = true}});
  describe_choice(
      v, s.directions,
      {"press_directions",
       "`normal`: the mean normal of the facets around a vertex; `sliding`: turned at rims and "
       "lobes, so that the force has a bound along slides there"},
      kPressDirections);
  v.flag(s.curved_facets, {"curved_facets",
                           "`true`: boundary facets are quadratic, with their edge midpoints on "
                           "the input surface; `false`: facets are flat"});
}

/// What the body is made of: one of three sections, and the lists that belong to it.
template <class V>
void describe_source(V& v, mesher::Settings& mesh, bool is_measured) {
  const bool has_mesh = !mesh.volume_mesh.path.empty();
  const bool has_image = !mesh.image.path.empty();
  const bool has_surface = !has_mesh && !has_image && !is_measured;
  if (v.has_section("surface", has_surface)) {
    v.section("surface", kOptional,
              "Outer surface of the body; this section, `[volume_mesh]` or `[image]`.",
              [&](auto& in) { describe_surface(in, mesh.surface); });
  }
  if (v.has_section("volume_mesh", has_mesh)) {
    v.section("volume_mesh", kOptional,
              "Tetrahedra that are used as they are; the response surface is a coarsening of their "
              "boundary. Of `[mesh]` only `patch_spacing`, `feature_angle`, `press_directions` "
              "and `curved_facets` apply.",
              [&](auto& in) { describe_volume_mesh(in, mesh.volume_mesh); });
  }
  if (v.has_section("image", has_image)) {
    v.section("image", kOptional,
              "Segmentation that Delaunay refinement meshes; detail thinner than a voxel may be "
              "missed.",
              [&](auto& in) { describe_image(in, mesh.image); });
  }
  v.sections("image_label", mesh.image.labels, kOptional,
             "Region of a label of the image. Repeat for each; voxels of other labels are no part "
             "of the body.",
             [](auto& in, auto& s) { describe_image_label(in, s); });
  v.sections("mesh_region", mesh.volume_mesh.regions, kOptional,
             "Region of a group of the volume mesh. Repeat for each; a group that is not listed is "
             "a region of its own name, and elements without a group are the region `matrix`.",
             [](auto& in, auto& s) { describe_mesh_region(in, s); });
}

}  // namespace palpate::app
