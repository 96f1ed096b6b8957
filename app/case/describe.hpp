// SPDX-License-Identifier: AGPL-3.0-or-later
// The one description of the keys of a case file. The reader, the printer and the reference page
// are visitors of it, so that they cannot disagree.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "app/case/case.hpp"
#include "app/case/quantity.hpp"
#include "fem/laws/law_table.hpp"

namespace palpate::app {

/// Values a constant may take. An open end is excluded.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  constexpr bool holds(double value) const {
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

template <class V>
void describe(V& v, SurfaceSection& s) {
  v.text(s.file,
         {"file", "closed triangulated surface: OFF, OBJ, PLY or STL; relative to the case file",
          kRequired});
  v.text(s.unit, {"unit", "length unit of the coordinates in the file", kRequired},
         unit_symbols(Dimension::Length));
  v.text(s.region, {"region", "name of the material region inside"});
}

template <class V>
void describe(V& v, InclusionSection& s) {
  v.text(s.file, {"file", "closed surface strictly inside the outer one", kRequired});
  v.text(s.unit, {"unit", "length unit of the coordinates in the file", kRequired},
         unit_symbols(Dimension::Length));
  v.text(s.region, {"region", "name of the material region inside", kRequired});
}

template <class V>
void describe(V& v, MeshSection& s) {
  v.quantity(s.patch_spacing, Dimension::Length,
             {"patch_spacing", "edge length of the response surface", kOptional, kPositive});
  v.quantity(s.element_size, Dimension::Length,
             {"element_size", "edge length of the boundary facets", kOptional, kPositive});
  v.number(s.interior_growth,
           {"interior_growth", "largest interior edge over element_size", kOptional, {.low = 1}});
  v.quantity(s.feature_angle, Dimension::Angle,
             {"feature_angle",
              "sharper edges of the surface are kept",
              kOptional,
              {.low = 0, .high = 3.141592653589793, .low_open = true}});
  v.flag(s.curved_facets, {"curved_facets",
                           "the tool meets a skin that is curved as the surface is, through the "
                           "middles of the edges of facets; false: flat facets"});
}

template <class V>
void describe(V& v, SupportSection& s) {
  v.text(s.shape, {"shape", "surface nodes inside this shape are held", kRequired},
         {"plane", "box", "sphere", "surface", "label"});
  v.quantity(s.normal_stiffness, Dimension::FoundationStiffness,
             {"normal_stiffness",
              "instead of being held, the facets inside rest on springs per area: along their "
              "normals at rest; 0 with the next: held",
              kOptional, kNotNegative});
  v.quantity(
      s.tangential_stiffness, Dimension::FoundationStiffness,
      {"tangential_stiffness", "of those springs, across the normals", kOptional, kNotNegative});
  if (v.when("shape", s.shape, "plane")) {
    v.point(s.point, Dimension::Length, {"point", "a point of the plane", kRequired});
    v.direction(s.normal,
                {"normal", "towards the held side; need not be of unit length", kRequired});
  }
  if (v.when("shape", s.shape, "box")) {
    v.point(s.low, Dimension::Length, {"low", "corner with the smallest coordinates", kRequired});
    v.point(s.high, Dimension::Length, {"high", "corner with the largest coordinates", kRequired});
  }
  if (v.when("shape", s.shape, "sphere")) {
    v.point(s.centre, Dimension::Length, {"centre", "centre of the sphere", kRequired});
    v.quantity(s.radius, Dimension::Length,
               {"radius", "radius of the sphere", kRequired, kPositive});
  }
  if (v.when("shape", s.shape, "surface")) {
    v.text(s.file,
           {"file", "closed surface, such as that of a bone: nodes inside or near it are held",
            kRequired});
    v.text(s.unit, {"unit", "length unit of the coordinates in the file", kRequired},
           unit_symbols(Dimension::Length));
    v.quantity(s.distance, Dimension::Length,
               {"distance", "how near is held", kRequired, kNotNegative});
  }
  if (v.when("shape", s.shape, "label")) {
    v.text(s.label, {"label",
                     "name of the held faces in the OBJ file of the surface: of a group (`g`), an "
                     "object (`o`) or a material (`usemtl`)",
                     kRequired});
  }
}

template <class V>
void describe_fibres(V& v, MaterialSection& s) {
  v.integer(s.fibre_families, {"fibre_families",
                               "1: fibres at +fibre_angle; 2: at both signs of it",
                               kOptional,
                               {.low = 1, .high = 2}});
  v.quantity(s.fibre_angle, Dimension::Angle,
             {"fibre_angle",
              "of the fibres from the mean direction, in their plane",
              kOptional,
              {.low = 0, .high = 1.5707963267948966}});
  v.text(s.fibre_field, {"fibre_field", "how the directions vary in the region"},
         {"constant", "cylindrical", "file", "laplace"});
  if (v.when("fibre_field", s.fibre_field, "constant")) {
    v.direction(s.fibre_direction, {"fibre_direction", "mean direction", kRequired});
    v.direction(s.fibre_plane,
                {"fibre_plane", "second direction of the plane of the fibres", kRequired});
  }
  if (v.when("fibre_field", s.fibre_field, "cylindrical")) {
    v.direction(s.fibre_axis,
                {"fibre_axis", "the mean direction runs around it, the plane along it", kRequired});
    v.point(s.fibre_axis_point, Dimension::Length,
            {"fibre_axis_point", "a point of the axis", kRequired});
  }
  if (v.when("fibre_field", s.fibre_field, "file")) {
    v.text(s.fibre_file,
           {"fibre_file",
            "directions at points, one line each below `x,y,z,fx,fy,fz` (or with `,sx,sy,sz`, a "
            "second "
            "direction of the plane); an element takes those of the point nearest to its centroid",
            kRequired});
    v.text(s.fibre_unit, {"fibre_unit", "length unit of x, y, z in the file", kRequired},
           unit_symbols(Dimension::Length));
    v.direction(
        s.fibre_plane,
        {"fibre_plane", "second direction of the plane where the file has none", kRequired});
  }
  if (v.when("fibre_field", s.fibre_field, "laplace")) {
    v.point(
        s.fibre_from_low, Dimension::Length,
        {"fibre_from_low",
         "corner of a box around the part of the surface where the fibres begin; they follow the "
         "gradient of a potential",
         kRequired});
    v.point(s.fibre_from_high, Dimension::Length,
            {"fibre_from_high", "its opposite corner", kRequired});
    v.point(s.fibre_to_low, Dimension::Length,
            {"fibre_to_low", "the same where they end", kRequired});
    v.point(s.fibre_to_high, Dimension::Length,
            {"fibre_to_high", "its opposite corner", kRequired});
    v.direction(s.fibre_plane,
                {"fibre_plane", "second direction of the plane of the fibres", kRequired});
  }
}

template <class V>
void describe(V& v, MaterialSection& s) {
  v.text(s.region, {"region", "region of an inclusion; empty means that of the surface"});
  Choices laws;
  for (const fem::LawEntry& law : fem::law_table()) laws.push_back(law.name);
  v.text(s.law, {"law", "hyperelastic law, see below"}, laws);
  for (const fem::LawEntry& law : fem::law_table()) {
    if (!v.when("law", s.law, law.name)) continue;
    for (const fem::LawConstant& constant : law.constants) {
      const Key key{constant.name,
                    constant.about,
                    kRequired,
                    {.low = constant.low,
                     .high = constant.high,
                     .low_open = constant.low_open,
                     .high_open = constant.high_open}};
      double& value = s.constant(constant.name);
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
void describe(V& v, ToolSection& s) {
  v.text(
      s.shape,
      {"shape",
       "of the rigid tool; disc: the flat end of an upright cylinder; cylinder: a lying one, its "
       "ends rounded to hemispheres"},
      {"sphere", "disc", "cylinder"});
  v.quantity(s.radius, Dimension::Length,
             {"radius", "of the sphere, the disc or the cross-section of the cylinder", kOptional,
              kPositive});
  v.text(
      s.friction,
      {"friction", "while pressing: the surface slides along the tool, or sticks where it touches"},
      {"frictionless", "no-slip"});
  if (v.when("shape", s.shape, "disc")) {
    v.quantity(s.edge_radius, Dimension::Length,
               {"edge_radius", "fillet of the edge, 0 when sharp; at most `radius`", kOptional,
                kNotNegative});
  }
  if (v.when("shape", s.shape, "cylinder")) {
    v.quantity(s.length, Dimension::Length,
               {"length", "between the centres of the ends", kRequired, kPositive});
    v.quantity(s.azimuth, Dimension::Angle,
               {"azimuth", "of the axis in the tangent plane", kOptional, kAny});
  }
}

template <class V>
void describe(V& v, IndentationSection& s) {
  v.quantity(s.depth, Dimension::Length, {"depth", "end of the normal path", kOptional, kPositive});
  v.integer(s.increments,
            {"increments", "steps of the normal path", kOptional, {.low = 2, .high = 1000}});
  v.quantity(s.lateral_travel, Dimension::Length,
             {"lateral_travel", "end of each lateral path", kOptional, kPositive});
  v.integer(
      s.lateral_increments,
      {"lateral_increments", "steps of each lateral path", kOptional, {.low = 2, .high = 1000}});
  v.quantities(s.lateral_depths, Dimension::Length,
               {"lateral_depths",
                "depths where lateral paths start, each at most `depth`; by default a third, two "
                "thirds and all of it",
                kOptional, kPositive});
  v.quantities(
      s.azimuths, Dimension::Angle,
      {"azimuths", "directions of the lateral paths in the tangent plane", kOptional, kAny});
  v.number(s.force_tolerance, {"force_tolerance",
                               "relative error of the tool force allowed to the solver",
                               kOptional,
                               {.low = 0, .high = 0.1, .low_open = true}});
}

template <class V>
void describe(V& v, SamplingSection& s) {
  v.text(s.method,
         {"method",
          "which points of the response surface are pressed: all; all surface nodes (patch_spacing "
          "is then element_size); or as many as it takes, the rest interpolated"},
         {"spacing", "nodes", "adaptive"});
  if (v.when("method", s.method, "adaptive")) {
    v.quantity(s.start_spacing, Dimension::Length,
               {"start_spacing", "of the first sites", kOptional, kPositive});
    v.number(s.tolerance,
             {"tolerance",
              "sites are added until 95 % of the forces at points held out are as near as this, "
              "relative to the local force",
              kOptional,
              {.low = 0, .high = 1, .low_open = true, .high_open = true}});
    v.integer(s.hold_out, {"hold_out",
                           "random points of the surface, pressed but never fitted",
                           kOptional,
                           {.low = 10, .high = 10000}});
    v.integer(s.most_sites, {"most_sites",
                             "end with this many sites, whatever the error",
                             kOptional,
                             {.low = 1, .high = 1000000}});
  }
}

template <class V>
void describe(V& v, FitSection& s) {
  v.number(s.relative_tolerance, {"relative_tolerance",
                                  "allowed error of a response over the local force",
                                  kOptional,
                                  {.low = 0, .high = 1}});
  v.quantity(s.absolute_tolerance, Dimension::Force,
             {"absolute_tolerance", "allowed error of a response; the larger of the two applies",
              kOptional, kPositive});
  v.integer(
      s.max_knots,
      {"max_knots", "largest number of knots of a response", kOptional, {.low = 2, .high = 1000}});
  v.flag(s.fill_holes,
         {"fill_holes",
          "give failed sites the mean response of their neighbours, marked as interpolated"});
  v.flag(
      s.between_nodes,
      {"between_nodes",
       "scale responses to be right in the mean between the nodes instead of at them, by how the "
       "forces curve along the surface"});
  v.text(s.responses,
         {"responses",
          "coupled: the lateral response grows with depth, best from several lateral_depths"},
         {"decoupled", "coupled"});
}

template <class V>
void describe(V& v, CertifySection& s) {
  v.number(s.friction,
           {"friction", "friction coefficient mu between tool and body", kOptional, kNotNegative});
  v.texts(s.devices,
          {"devices", "device profiles to certify for: TOML files, relative to the case file"});
}

template <class V>
void describe(V& v, SimulateSection& s) {
  v.quantity(s.rate, Dimension::Frequency,
             {"rate", "of the force loop", kOptional, {.low = 100, .high = 100000}});
  v.quantity(s.mass, Dimension::Mass, {"mass", "of the simulated device", kOptional, kPositive});
  v.quantity(s.damping, Dimension::Damping,
             {"damping", "viscous damping of the simulated device", kOptional, kNotNegative});
  v.quantity(s.coulomb_friction, Dimension::Force,
             {"coulomb_friction", "dry friction of the simulated device", kOptional, kNotNegative});
  v.quantity(
      s.hand_stiffness, Dimension::Stiffness,
      {"hand_stiffness", "spring between the hand's path and the device", kOptional, kPositive});
  v.quantity(s.hand_damping, Dimension::Damping,
             {"hand_damping", "damper beside that spring", kOptional, kNotNegative});
  v.quantity(s.press_depth, Dimension::Length,
             {"press_depth", "depth of the hand's path below the surface", kOptional, kPositive});
  v.quantity(s.press_speed, Dimension::Speed,
             {"press_speed", "of the approach, the press and the release", kOptional, kPositive});
  v.quantity(
      s.slide_length, Dimension::Length,
      {"slide_length", "along the surface; shorter where the surface ends", kOptional, kPositive});
  v.quantity(s.slide_speed, Dimension::Speed,
             {"slide_speed", "along the surface", kOptional, kPositive});
}

template <class V>
void describe(V& v, SolverSection& s) {
  v.text(
      s.element,
      {"element",
       "tetrahedra of ten nodes with an element-constant pressure; with a continuous one, where "
       "pressures are wanted near poisson = 0.5 (slower); or, to compare with other programs, of "
       "displacements alone (too stiff near poisson = 0.5); tet4: of four nodes, for quick looks "
       "at "
       "a case, with forces too high by tens of percent"},
      {"tet10-pressure", "tet10-nodal-pressure", "tet10-displacement", "tet4"});
  v.flag(s.refine_under_tool,
         {"refine_under_tool",
          "divide the elements around the tool in eight, for each site anew: for contacts smaller "
          "than a facet"});
}

template <class V>
void describe(V& v, GravitySection& s) {
  v.point(s.acceleration, Dimension::Acceleration,
          {"acceleration", "of gravity; all 0: the body has no weight"});
  v.quantity(s.density, Dimension::Density,
             {"density", "at rest, of every region", kOptional, kPositive});
}

template <class V>
void describe(V& v, OutputSection& s) {
  v.text(
      s.folder,
      {"folder", "where artifacts go, relative to the current folder; empty means `out/<name>`"});
}

template <class V>
void describe(V& v, Case& c) {
  v.text(c.name, {"name", "of the body; names the output; empty means the name of the case file"});
  v.section("surface", c.surface, kRequired, "The outer skin of the body.");
  v.sections("inclusion", c.inclusions, kOptional,
             "A region of another material inside the body. Repeat for each.");
  v.section("mesh", c.mesh, kOptional, "Resolution.");
  v.sections("support", c.supports, kRequired, "Where the body is held. Repeat for each.");
  v.sections("material", c.materials, kRequired, "One for each region.");
  v.section("tool", c.tool, kOptional, "What presses.");
  v.section("indentation", c.indentation, kOptional, "What is computed at each site.");
  v.section("sampling", c.sampling, kOptional, "Where the tool is pressed.");
  v.section("solver", c.solver, kOptional, "How the equilibria are computed.");
  v.section("gravity", c.gravity, kOptional,
            "The body comes to equilibrium under its weight before it is touched.");
  v.section("fit", c.fit, kOptional, "From curves to responses.");
  v.section("certify", c.certify, kOptional, "Passivity certificate.");
  v.section("simulate", c.simulate, kOptional, "Scripted session of `palpate simulate`.");
  v.section("output", c.output, kOptional, "Where results go.");
}

}  // namespace palpate::app
