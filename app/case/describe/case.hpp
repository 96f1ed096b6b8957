// SPDX-License-Identifier: AGPL-3.0-or-later
// The one description of the keys of a case file: name, unit, range and meaning of each, bound to
// the field of the settings of a stage. The reader, the printer and the reference page are visitors
// of it, so that they cannot disagree.
#pragma once

#include "app/case/case.hpp"
#include "app/case/describe/body.hpp"
#include "app/case/describe/campaign.hpp"
#include "app/case/describe/library.hpp"
#include "app/case/describe/material.hpp"
#include "app/case/describe/session.hpp"
#include "app/case/describe/support.hpp"

namespace palpate::app {

template <class V>
void describe(V& v, OutputSection& s) {
  v.text(s.folder, {"folder",
                    "folder of the artifacts, relative to the current folder; empty means "
                    "`out/<name>`"});
}

template <class V>
void describe(V& v, DeformationSection& s) {
  v.integer(s.depths, {"depths",
                       "depths of a press at which the campaign keeps the displacement of the "
                       "skin, for `deformation.pdef`; 0: it keeps none",
                       kOptional,
                       {.low = 0, .high = 32}});
  v.integer(s.modes, {"modes",
                      "largest number of shapes from which the displacements are blended",
                      kOptional,
                      {.low = 1, .high = 512}});
}

/// Surface and responses of measurements.
template <class V>
void describe_measured(V& v, Case& c) {
  if (v.has_section("measured", !c.records.empty())) {
    v.section("measured", kOptional,
              "Body of measurements alone, instead of `[surface]`, `[volume_mesh]` or `[image]`. "
              "Beside it there are only `[fit]`, `[certify]`, `[simulate]` and `[output]`.",
              [&](auto& in) {
                describe_path(in, c.records,
                              {"records",
                               "sidecar of the records (docs/measured.md), relative to "
                               "the case",
                               kRequired});
              });
  }
}

template <class V>
void describe(V& v, Case& c) {
  v.text(c.name,
         {"name", "name of the body and of its output folder; empty means that of the case file"});
  describe_measured(v, c);
  describe_source(v, c.mesh, !c.records.empty());
  const bool has_inside = c.records.empty();
  const Presence of_inside = has_inside ? kRequired : kOptional;
  v.sections("inclusion", c.mesh.inclusions, kOptional,
             "Region of another material inside the body. Repeat for each.",
             [](auto& in, auto& s) { describe_inclusion(in, s); });
  v.sections("layer", c.mesh.layers, kOptional,
             "Layer below the outer surface, the outermost first. Repeat for each.",
             [](auto& in, auto& s) { describe_layer(in, s); });
  if (v.has_section("mesh", has_inside))
    v.section("mesh", kOptional, "Resolution.", [&](auto& in) { describe_mesh(in, c.mesh); });
  v.sections("support", c.supports, of_inside,
             "Fixed nodes or an elastic foundation. Repeat for each.",
             [](auto& in, auto& s) { describe_support(in, s); });
  v.sections("press", c.mesh.press, kOptional,
             "Where the tool may be pressed: sites lie in one of these zones. Without a zone, "
             "everywhere.",
             [](auto& in, auto& s) { describe_press(in, s); });
  v.sections("material", c.materials, of_inside, "Law and constants, one table for each region.",
             [](auto& in, auto& s) { describe(in, s); });
  if (v.has_section("tool", has_inside))
    v.section("tool", kOptional, "Tool of the campaign.",
              [&](auto& in) { describe_tool(in, c.campaign.indentation); });
  if (v.has_section("indentation", has_inside))
    v.section("indentation", kOptional, "Paths at each site.",
              [&](auto& in) { describe_indentation(in, c.campaign.indentation); });
  if (v.has_section("sampling", has_inside))
    v.section("sampling", kOptional, "Choice of the sites.",
              [&](auto& in) { describe(in, c.sampling); });
  if (v.has_section("solver", has_inside))
    v.section("solver", kOptional, "Finite elements.",
              [&](auto& in) { describe_solver(in, c.campaign); });
  if (v.has_section("gravity", has_inside))
    v.section("gravity", kOptional, "Preload: the body deforms under its weight before touch.",
              [&](auto& in) { describe_gravity(in, c.campaign.gravity); });
  v.section("fit", kOptional, "From raw curves to responses.",
            [&](auto& in) { describe_fit(in, c.fit); });
  if (v.has_section("deformation", has_inside))
    v.section("deformation", kOptional, "The skin as it is pressed, for pictures.",
              [&](auto& in) { describe(in, c.deformation); });
  v.section("certify", kOptional, "Passivity certificate.",
            [&](auto& in) { describe(in, c.certify); });
  v.section("simulate", kOptional, "Scripted session of `palpate simulate`.",
            [&](auto& in) { describe(in, c.simulate); });
  v.section("output", kOptional, "Where the artifacts go.",
            [&](auto& in) { describe(in, c.output); });
}

}  // namespace palpate::app
