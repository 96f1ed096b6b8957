// SPDX-License-Identifier: AGPL-3.0-or-later
// The sections of the campaign: tool, paths, sites, elements, gravity.
#pragma once

#include <array>
#include <string>

#include "app/case/case.hpp"
#include "app/case/describe/key.hpp"

namespace palpate::app {

template <class V>
void describe_tool(V& v, fem::IndentationSettings& s) {
  describe_choice(v, s.tool.shape,
                  {"shape",
                   "rigid tool; `disc`: end of an upright cylinder; `cylinder`: on its side, with "
                   "hemispherical ends"},
                  kToolShapes);
  v.quantity_or_auto(s.tool.radius, Dimension::Length,
                     {"radius",
                      "radius of the sphere, the disc or the cross-section of the cylinder; "
                      "`auto`: 0.65 of `patch_spacing`",
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
  v.quantity_or_auto(
      s.depth, Dimension::Length,
      {"depth",
       "depth at the end of the normal path; `auto`: 0.4 of `patch_spacing`, but at most a fifth "
       "of the smallest dimension of the body",
       kOptional, kPositive});
  v.integer(s.increments,
            {"increments", "increments of the normal path", kOptional, {.low = 2, .high = 1000}});
  v.quantity_or_auto(
      s.lateral_travel, Dimension::Length,
      {"lateral_travel", "travel at the end of each lateral path; `auto`: half of `depth`",
       kOptional, kPositive});
  v.integer(s.lateral_increments, {"lateral_increments",
                                   "increments of each lateral path",
                                   kOptional,
                                   {.low = 2, .high = 1000}});
  v.quantities_or_auto(
      s.lateral_depths, Dimension::Length,
      {"lateral_depths",
       "depths of the lateral paths, each at most `depth`; `auto`: a third, two thirds and all of "
       "`depth`",
       kOptional, kPositive});
  v.quantities(
      s.azimuths, Dimension::Angle,
      {"azimuths", "directions of the lateral paths in the tangent plane", kOptional, kAny});
  v.flag(
      s.drag_across,
      {"drag_across",
       "with a single azimuth, a shorter lateral path across it at the middle lateral depth too: "
       "by it `fit` knows how the response leans, and in which direction it is softer"});
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
  v.quantity_or_auto(
      s.initial_spacing, Dimension::Length,
      {"initial_spacing",
       "distance between the sites of the first round; `auto`: three times `patch_spacing`",
       kOptional, kPositive});
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
void describe_solver(V& v, fem::CampaignSettings& s) {
  describe_choice(v, s.dilatation, {"element", "finite element, see [below](#elements)"},
                  kElements);
  v.flag_or_count(
      s.indentation.refine_under_tool, "contact",
      {"refine_under_tool",
       "divides the elements under the tool: once, as often as a number says, or as the contact "
       "asks for (\"contact\")",
       kOptional,
       {.low = 0, .high = fem::IndentationSettings::kMaxRefinements}});
  v.integer(s.mesh_error_sites,
            {"mesh_error_sites",
             "largest number of sites, of those at sharp edges and of the others each, that are "
             "pressed on a finer mesh too, which bounds the "
             "[error of the mesh](campaigns.md#the-error-of-the-mesh); 0: unknown",
             kOptional,
             {.low = 0, .high = 1000}});
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

}  // namespace palpate::app
