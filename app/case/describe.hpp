// SPDX-License-Identifier: AGPL-3.0-or-later
// The one description of the keys of a case file: name, unit, range and meaning of each, bound to
// the field of the settings of a stage. The reader, the printer and the reference page are visitors
// of it, so that they cannot disagree.
#pragma once

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "app/case/case.hpp"
#include "app/case/names.hpp"
#include "app/case/quantity.hpp"
#include "fem/laws/law_table.hpp"

namespace palpate::app {

/// Values that a key accepts. An open end is excluded.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  constexpr bool contains(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }
};

inline constexpr Range kAny{};
inline constexpr Range kPositive{.low = 0, .low_open = true};
inline constexpr Range kNotNegative{.low = 0};

enum class Presence { Optional, Required };

struct Key {
  std::string_view name;
  std::string_view about;
  Presence presence = Presence::Optional;
  Range range = kAny;
};

using Choices = std::vector<std::string_view>;

constexpr auto kRequired = Presence::Required;
constexpr auto kOptional = Presence::Optional;

/// A value that a case file writes as one of the names of a table.
template <class V, class T, std::size_t N>
void describe_choice(V& v, T& value, const Key& key, const std::array<Named<T>, N>& table) {
  std::string name(name_in(table, value));
  v.text(name, key, names_in(table));
  for (const Named<T>& entry : table)
    if (entry.name == name) value = entry.value;
}

/// The length of the unit of a file, m, written by its symbol.
template <class V>
void describe_length_unit(V& v, double& metres, const Key& key) {
  const auto units = units_of(Dimension::Length);
  const auto same =
      std::find_if(units.begin(), units.end(), [&](const Unit& unit) { return unit.si == metres; });
  std::string symbol(same == units.end() ? std::string_view{} : same->symbol);
  v.text(symbol, key, unit_symbols(Dimension::Length));
  for (const Unit& unit : units)
    if (unit.symbol == symbol) metres = unit.si;
}

template <class V>
void describe_path(V& v, std::filesystem::path& path, const Key& key) {
  std::string text = path.string();
  v.text(text, key);
  path = text;
}

template <class V>
void describe_repair(V& v, mesher::RepairSettings& s) {
  describe_choice(
      v, s.mode,
      {"repair",
       "faults of the surface: `auto` repairs them, by an alpha wrap where local repairs do not "
       "do, `none` refuses them, `wrap` replaces the surface by its alpha wrap"},
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
  v.quantity(s.patch_spacing, Dimension::Length,
             {"patch_spacing", "edge length of the response surface", kOptional, kPositive});
  v.quantity(s.element_size, Dimension::Length,
             {"element_size", "edge length of the boundary facets", kOptional, kPositive});
  v.number(s.interior_coarsening, {"interior_coarsening",
                                   "target ratio of the largest interior edge to `element_size`",
                                   kOptional,
                                   {.low = 1}});
  v.number(s.support_coarsening,
           {"support_coarsening",
            "target ratio of the edges at fixed supports to `element_size`; above 1, Delaunay "
            "refinement makes the mesh",
            kOptional,
            {.low = 1}});
  v.quantity(s.feature_angle, Dimension::Angle,
             {"feature_angle",
              "edges of the surface with a larger dihedral deviation are preserved",
              kOptional,
              {.low = 0, .high = std::numbers::pi, .low_open = true}});
  v.flag(s.curved_facets, {"curved_facets",
                           "`true`: boundary facets are quadratic, with their edge midpoints on "
                           "the input surface; `false`: facets are flat"});
}

/// The alternative A of a variant; it becomes that alternative, with default values, if it was not.
template <class A, class Variant>
A& alternative(Variant& variant) {
  if (!std::holds_alternative<A>(variant)) variant.template emplace<A>();
  return std::get<A>(variant);
}

/// In the order of the alternatives of mesher::Support.
inline constexpr std::array<std::string_view, 5> kSupportShapes{"plane", "box", "sphere", "surface",
                                                                "label"};

template <class V>
void describe_support_shape(V& v, const std::string& shape, mesher::Support& where) {
  if (v.when("shape", shape, "plane")) {
    auto& plane = alternative<mesher::PlaneSupport>(where);
    v.point(plane.point, Dimension::Length, {"point", "a point of the plane", kRequired});
    v.direction(
        plane.normal,
        {"normal", "normal of the plane, towards the supported side; of any length", kRequired});
  }
  if (v.when("shape", shape, "box")) {
    auto& box = alternative<mesher::BoxSupport>(where);
    v.point(box.low, Dimension::Length, {"low", "corner with the smallest coordinates", kRequired});
    v.point(box.high, Dimension::Length,
            {"high", "corner with the largest coordinates", kRequired});
  }
  if (v.when("shape", shape, "sphere")) {
    auto& sphere = alternative<mesher::SphereSupport>(where);
    v.point(sphere.centre, Dimension::Length, {"centre", "centre of the sphere", kRequired});
    v.quantity(sphere.radius, Dimension::Length,
               {"radius", "radius of the sphere", kRequired, kPositive});
  }
  if (v.when("shape", shape, "surface")) {
    auto& support = alternative<mesher::SurfaceSupport>(where);
    describe_path(v, support.surface.path,
                  {"file", "watertight surface, such as that of a bone", kRequired});
    describe_length_unit(v, support.surface.unit,
                         {"unit", "length unit of the coordinates in the file", kRequired});
    v.quantity(support.distance, Dimension::Length,
               {"distance", "nodes inside the surface or nearer to it than this are supported",
                kRequired, kNotNegative});
  }
  if (v.when("shape", shape, "label")) {
    v.text(alternative<mesher::LabelSupport>(where).label,
           {"label",
            "name of faces in the file of the surface (OBJ: a group `g`, an object `o` or a "
            "material `usemtl`; STL: a solid; PLY: a colour, `#ff0000`; VTK: `array=value`), of a "
            "set of a volume mesh, "
            "or of a region of an image",
            kRequired});
  }
}

template <class V>
void describe_zone(V& v, mesher::Zone& s, std::string_view about, std::string& shape) {
  shape = kSupportShapes[s.shape.index()];
  v.text(shape, {"shape", about, kRequired}, {kSupportShapes.begin(), kSupportShapes.end()});
  v.flag(s.inverted, {"invert", "`true`: everything but what the shape contains"});
}

template <class V>
void describe_press(V& v, mesher::Zone& s) {
  std::string shape;
  describe_zone(v, s, "shape that contains sites", shape);
  describe_support_shape(v, shape, s.shape);
}

template <class V>
void describe_support(V& v, mesher::Springs& s) {
  std::string shape;
  describe_zone(v, s.where, "shape that contains the supported surface nodes", shape);
  v.quantity(s.normal_stiffness, Dimension::FoundationStiffness,
             {"normal_stiffness",
              "elastic foundation along the facet normals; fixed nodes when this and "
              "`tangential_stiffness` are 0",
              kOptional, kNotNegative});
  v.quantity(s.tangential_stiffness, Dimension::FoundationStiffness,
             {"tangential_stiffness", "stiffness of the elastic foundation across the normals",
              kOptional, kNotNegative});
  describe_support_shape(v, shape, s.where.shape);
}

template <class V>
void describe_sampled_fibres(V& v, MaterialSection& s) {
  describe_path(v, s.fibre_file,
                {"fibre_file",
                 "fibre directions at points, see below; an element takes the directions of the "
                 "point nearest to its centroid",
                 kRequired});
  describe_length_unit(v, s.fibre_unit,
                       {"fibre_unit", "length unit of x, y, z in the file", kRequired});
  v.direction(s.law.fibres.second,
              {"fibre_plane",
               "second direction of the plane of the fibres, where the file has none", kRequired});
}

template <class V>
void describe_laplace_fibres(V& v, fem::FibreField& fibres) {
  v.point(
      fibres.from.low, Dimension::Length,
      {"fibre_from_low",
       "smallest corner of a box around the start of the fibres; they follow a Laplace potential",
       kRequired});
  v.point(fibres.from.high, Dimension::Length,
          {"fibre_from_high", "largest corner of that box", kRequired});
  v.point(
      fibres.to.low, Dimension::Length,
      {"fibre_to_low", "smallest corner of a box around the part where the fibres end", kRequired});
  v.point(fibres.to.high, Dimension::Length,
          {"fibre_to_high", "largest corner of that box", kRequired});
  v.direction(fibres.second,
              {"fibre_plane", "second direction of the plane of the fibres", kRequired});
}

template <class V>
void describe_fibres(V& v, MaterialSection& s) {
  fem::FibreField& fibres = s.law.fibres;
  v.integer(fibres.families,
            {"fibre_families",
             "1: one family, at `+fibre_angle`; 2: two families, at `+fibre_angle` and "
             "`-fibre_angle`",
             kOptional,
             {.low = 1, .high = 2}});
  v.quantity(fibres.angle, Dimension::Angle,
             {"fibre_angle",
              "angle between a fibre family and the mean direction, in the plane of the fibres",
              kOptional,
              {.low = 0, .high = std::numbers::pi / 2}});
  describe_choice(v, fibres.kind, {"fibre_field", "variation of the directions over the region"},
                  kFibreFields);
  const std::string field(name_in(kFibreFields, fibres.kind));
  if (v.when("fibre_field", field, "constant")) {
    v.direction(fibres.first, {"fibre_direction", "mean direction", kRequired});
    v.direction(fibres.second,
                {"fibre_plane", "second direction of the plane of the fibres", kRequired});
  }
  if (v.when("fibre_field", field, "cylindrical")) {
    v.direction(
        fibres.first,
        {"fibre_axis",
         "axis; the mean direction is circumferential, and the plane of the fibres contains "
         "the axial direction",
         kRequired});
    v.point(fibres.origin, Dimension::Length,
            {"fibre_axis_point", "a point of the axis", kRequired});
  }
  if (v.when("fibre_field", field, "file")) describe_sampled_fibres(v, s);
  if (v.when("fibre_field", field, "laplace")) describe_laplace_fibres(v, fibres);
}

/// The value of a constant of a law; 0 when it is new.
inline double& value_of(fem::LawConstants& law, std::string_view name) {
  for (auto& [known, value] : law.values)
    if (known == name) return value;
  return law.values.emplace_back(name, 0.0).second;
}

template <class V>
void describe(V& v, MaterialSection& s) {
  v.text(s.region, {"region", "region of the body; empty means that of the outer surface"});
  v.quantity(s.density, Dimension::Density,
             {"density", "reference density, for the weight; 0: that of `[gravity]`", kOptional,
              kNotNegative});
  Choices laws;
  for (const fem::LawEntry& law : fem::law_table()) laws.push_back(law.name);
  v.text(s.law.law, {"law", "hyperelastic law, see [theory](theory-fem.md)"}, laws);
  for (const fem::LawEntry& law : fem::law_table()) {
    if (!v.when("law", s.law.law, law.name)) continue;
    for (const fem::LawConstant& constant : law.constants) {
      const Key key{constant.name,
                    constant.about,
                    kRequired,
                    {.low = constant.low,
                     .high = constant.high,
                     .low_open = constant.low_open,
                     .high_open = constant.high_open}};
      double& value = value_of(s.law, constant.name);
      if (constant.is_stress) {
        v.quantity(value, Dimension::Pressure, key);
      } else {
        v.number(value, key);
      }
    }
    if (law.has_fibres) describe_fibres(v, s);
  }
}

template <class V>
void describe_tool(V& v, fem::IndentationSettings& s) {
  describe_choice(v, s.tool.shape,
                  {"shape",
                   "rigid tool; `disc`: end of an upright cylinder; `cylinder`: on its side, with "
                   "hemispherical ends"},
                  kToolShapes);
  v.quantity(s.tool.radius, Dimension::Length,
             {"radius", "radius of the sphere, the disc or the cross-section of the cylinder",
              kOptional, kPositive});
  describe_choice(
      v, s.friction,
      {"friction",
       "contact on the normal path: `frictionless` sliding along the tool, or `no-slip` "
       "after touch"},
      kToolFrictions);
  const std::string shape(name_in(kToolShapes, s.tool.shape));
  if (v.when("shape", shape, "disc")) {
    v.quantity(s.tool.edge_radius, Dimension::Length,
               {"edge_radius", "fillet radius of the edge, at most `radius`; 0: a sharp edge",
                kOptional, kNotNegative});
  }
  if (v.when("shape", shape, "cylinder")) {
    v.quantity(s.tool.length, Dimension::Length,
               {"length", "distance between the centres of the ends", kRequired, kPositive});
    v.quantity(s.tool_azimuth, Dimension::Angle,
               {"azimuth", "direction of the cylinder axis in the tangent plane", kOptional, kAny});
  }
}

template <class V>
void describe_indentation(V& v, fem::IndentationSettings& s) {
  v.quantity(s.depth, Dimension::Length,
             {"depth", "depth at the end of the normal path", kOptional, kPositive});
  v.integer(s.increments,
            {"increments", "increments of the normal path", kOptional, {.low = 2, .high = 1000}});
  v.quantity(s.lateral_travel, Dimension::Length,
             {"lateral_travel", "travel at the end of each lateral path", kOptional, kPositive});
  v.integer(s.lateral_increments, {"lateral_increments",
                                   "increments of each lateral path",
                                   kOptional,
                                   {.low = 2, .high = 1000}});
  v.quantities(s.lateral_depths, Dimension::Length,
               {"lateral_depths",
                "depths of the lateral paths, each at most `depth`; without this key a third, two "
                "thirds and all of `depth`",
                kOptional, kPositive});
  v.quantities(
      s.azimuths, Dimension::Angle,
      {"azimuths", "directions of the lateral paths in the tangent plane", kOptional, kAny});
  v.number(s.force_tolerance, {"force_tolerance",
                               "relative tolerance of the tool force at equilibrium",
                               kOptional,
                               {.low = 0, .high = 0.1, .low_open = true}});
}

inline constexpr std::array kSamplingMethods{Named{SamplingMethod::Vertices, "vertices"},
                                             Named{SamplingMethod::Nodes, "nodes"},
                                             Named{SamplingMethod::Adaptive, "adaptive"}};

template <class V>
void describe(V& v, SamplingSection& s) {
  describe_choice(v, s.method,
                  {"method",
                   "sites: response vertices, surface nodes (`patch_spacing` is then "
                   "`element_size`) or adaptive"},
                  kSamplingMethods);
  if (!v.when("method", std::string(name_in(kSamplingMethods, s.method)), "adaptive")) return;
  v.quantity(
      s.initial_spacing, Dimension::Length,
      {"initial_spacing", "distance between the sites of the first round", kOptional, kPositive});
  v.number(s.tolerance,
           {"tolerance",
            "sites are added until the 95th-percentile relative error of the normal forces at "
            "hold-out points is below this",
            kOptional,
            {.low = 0, .high = 1, .low_open = true, .high_open = true}});
  v.integer(s.hold_out_points, {"hold_out_points",
                                "number of random surface points that are solved directly and "
                                "never fitted",
                                kOptional,
                                {.low = 10, .high = 10000}});
  v.integer(s.max_sites, {"max_sites",
                          "largest number of sites, whatever the error",
                          kOptional,
                          {.low = 1, .high = 1000000}});
}

template <class V>
void describe_fit(V& v, fitting::FitSettings& s) {
  v.number(s.relative_tolerance, {"relative_tolerance",
                                  "tolerated error of a response, relative to the local force",
                                  kOptional,
                                  {.low = 0, .high = 1}});
  v.quantity(s.absolute_tolerance, Dimension::Force,
             {"absolute_tolerance",
              "tolerated error of a response; the larger of the two tolerances applies", kOptional,
              kPositive});
  v.integer(
      s.max_knots,
      {"max_knots", "largest number of knots of a response", kOptional, {.low = 2, .high = 1000}});
  v.flag(s.fill_holes, {"fill_holes",
                        "gives failed sites the mean response of their neighbours, marked as "
                        "interpolated"});
  v.flag(s.between_nodes,
         {"interpolation_correction",
          "scales responses so that interpolated forces have no mean error between the vertices, "
          "by the curvature of the force along the surface"});
  describe_choice(
      v, s.kind,
      {"responses",
       "`coupled`: the lateral response grows with depth; give several `lateral_depths`"},
      kResponseKinds);
}

template <class V>
void describe(V& v, CertifySection& s) {
  v.number(s.friction,
           {"friction", "friction coefficient mu between tool and body", kOptional, kNotNegative});
  v.texts(s.devices, {"devices", "device profiles (TOML) to certify, relative to the case"});
}

inline constexpr std::array kSlidePaths{Named{SlidePath::Longest, "longest"},
                                        Named{SlidePath::Between, "between"}};

template <class V>
void describe_slide(V& v, SimulateSection& s) {
  v.quantity(s.slide_speed, Dimension::Speed,
             {"slide_speed", "mean speed of the slide", kOptional, kPositive});
  describe_choice(v, s.path,
                  {"path",
                   "`longest`: slides straight on from the middle of the part with responses; "
                   "`between`: from one point to another"},
                  kSlidePaths);
  const std::string path(name_in(kSlidePaths, s.path));
  if (v.when("path", path, "longest")) {
    v.quantity(s.slide_length, Dimension::Length,
               {"slide_length", "length of the slide; shorter where the surface ends", kOptional,
                kPositive});
  }
  if (v.when("path", path, "between")) {
    v.point(s.from, Dimension::Length,
            {"from", "the slide starts in the triangle nearest to this point", kRequired});
    v.point(s.to, Dimension::Length,
            {"to", "the slide ends in the triangle nearest to this point", kRequired});
  }
}

template <class V>
void describe(V& v, SimulateSection& s) {
  v.quantity(s.rate, Dimension::Frequency,
             {"rate", "sampling rate of the force loop", kOptional, {.low = 100, .high = 100000}});
  v.quantity(s.device.mass, Dimension::Mass,
             {"mass", "mass of the simulated device", kOptional, kPositive});
  v.quantity(s.device.damping, Dimension::Damping,
             {"damping", "viscous damping of the simulated device", kOptional, kNotNegative});
  v.quantity(s.device.coulomb_friction, Dimension::Force,
             {"coulomb_friction", "dry friction of the simulated device", kOptional, kNotNegative});
  v.quantity(
      s.device.hand_stiffness, Dimension::Stiffness,
      {"hand_stiffness", "stiffness of the spring between the path of the hand and the device",
       kOptional, kPositive});
  v.quantity(s.device.hand_damping, Dimension::Damping,
             {"hand_damping", "damping in parallel with that spring", kOptional, kNotNegative});
  v.quantity(
      s.press_depth, Dimension::Length,
      {"press_depth", "depth of the path of the hand below the surface", kOptional, kPositive});
  v.quantity(s.press_speed, Dimension::Speed,
             {"press_speed", "mean speed of approach, press and release", kOptional, kPositive});
  describe_slide(v, s);
}

template <class V>
void describe_solver(V& v, fem::CampaignSettings& s) {
  describe_choice(v, s.dilatation, {"element", "finite element, see [below](#elements)"},
                  kElements);
  v.flag(s.indentation.refine_under_tool,
         {"refine_under_tool",
          "divides the elements under the tool into eight at each site, for contacts smaller than "
          "a facet"});
}

template <class V>
void describe_gravity(V& v, fem::Gravity& s) {
  v.point(s.acceleration, Dimension::Acceleration,
          {"acceleration", "acceleration of gravity; all 0: no preload"});
  v.quantity(s.density, Dimension::Density,
             {"density", "reference density of the regions whose material has none", kOptional,
              kPositive});
  describe_choice(v, s.shape,
                  {"shape",
                   "shape of the surface of the case: `unloaded`: without weight; `loaded`: as the "
                   "body lies under "
                   "its weight, from which its shape without weight is computed"},
                  kGivenShapes);
}

template <class V>
void describe(V& v, OutputSection& s) {
  v.text(s.folder, {"folder",
                    "folder of the artifacts, relative to the current folder; empty means "
                    "`out/<name>`"});
}

/// What the body is made of: one of three sections, and the lists that belong to it.
template <class V>
void describe_source(V& v, mesher::Settings& mesh) {
  const bool has_mesh = !mesh.volume_mesh.path.empty();
  const bool has_image = !mesh.image.path.empty();
  const bool has_surface = !has_mesh && !has_image;
  if (v.has_section("surface", has_surface)) {
    v.section("surface", kOptional,
              "Outer surface of the body; this section, `[volume_mesh]` or `[image]`.",
              [&](auto& in) { describe_surface(in, mesh.surface); });
  }
  if (v.has_section("volume_mesh", has_mesh)) {
    v.section("volume_mesh", kOptional,
              "Tetrahedra that are used as they are; the response surface is a coarsening of their "
              "boundary. Of `[mesh]` only `patch_spacing`, `feature_angle` and `curved_facets` "
              "apply.",
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

template <class V>
void describe(V& v, Case& c) {
  v.text(c.name,
         {"name", "name of the body and of its output folder; empty means that of the case file"});
  describe_source(v, c.mesh);
  v.sections("inclusion", c.mesh.inclusions, kOptional,
             "Region of another material inside the body. Repeat for each.",
             [](auto& in, auto& s) { describe_inclusion(in, s); });
  v.sections("layer", c.mesh.layers, kOptional,
             "Layer below the outer surface, the outermost first. Repeat for each.",
             [](auto& in, auto& s) { describe_layer(in, s); });
  v.section("mesh", kOptional, "Resolution.", [&](auto& in) { describe_mesh(in, c.mesh); });
  v.sections("support", c.supports, kRequired,
             "Fixed nodes or an elastic foundation. Repeat for each.",
             [](auto& in, auto& s) { describe_support(in, s); });
  v.sections("press", c.mesh.press, kOptional,
             "Where the tool may be pressed: sites lie in one of these zones. Without a zone, "
             "everywhere.",
             [](auto& in, auto& s) { describe_press(in, s); });
  v.sections("material", c.materials, kRequired, "Law and constants, one table for each region.",
             [](auto& in, auto& s) { describe(in, s); });
  v.section("tool", kOptional, "Tool of the campaign.",
            [&](auto& in) { describe_tool(in, c.campaign.indentation); });
  v.section("indentation", kOptional, "Paths at each site.",
            [&](auto& in) { describe_indentation(in, c.campaign.indentation); });
  v.section("sampling", kOptional, "Choice of the sites.",
            [&](auto& in) { describe(in, c.sampling); });
  v.section("solver", kOptional, "Finite elements.",
            [&](auto& in) { describe_solver(in, c.campaign); });
  v.section("gravity", kOptional, "Preload: the body deforms under its weight before touch.",
            [&](auto& in) { describe_gravity(in, c.campaign.gravity); });
  v.section("fit", kOptional, "From raw curves to responses.",
            [&](auto& in) { describe_fit(in, c.fit); });
  v.section("certify", kOptional, "Passivity certificate.",
            [&](auto& in) { describe(in, c.certify); });
  v.section("simulate", kOptional, "Scripted session of `palpate simulate`.",
            [&](auto& in) { describe(in, c.simulate); });
  v.section("output", kOptional, "Where the artifacts go.",
            [&](auto& in) { describe(in, c.output); });
}

}  // namespace palpate::app
