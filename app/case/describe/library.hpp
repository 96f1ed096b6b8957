// SPDX-License-Identifier: AGPL-3.0-or-later
// The sections that make a library of the curves.
#pragma once

#include "app/case/case.hpp"
#include "app/case/describe/key.hpp"

namespace palpate::app {

template <class V>
void describe_fit(V& v, fitting::FitSettings& s) {
  v.number(s.relative_tolerance, {"relative_tolerance",
                                  "tolerated error of a response, relative to the local force",
                                  kOptional,
                                  {.low = 0, .high = 1}});
  v.quantity_or_auto(
      s.absolute_tolerance, Dimension::Force,
      {"absolute_tolerance",
       "tolerated error of a response; the larger of the two tolerances applies; `auto`: 0.001 of "
       "the largest force of each curve",
       kOptional, kPositive});
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
  v.flag(s.lean,
         {"lean",
          "a straight press leans where the force of the solid does: beside supports, above "
          "inclusions"});
  v.flag(s.soft_axes,
         {"soft_axes",
          "the lateral response is softer in the directions in which drags are; of coupled "
          "responses, by `drag_across` or several `azimuths`"});
  describe_choice(
      v, s.kind,
      {"responses",
       "`coupled`: lateral response and lean grow with depth, better by several `lateral_depths`; "
       "`decoupled`: they are the same at every depth"},
      kResponseKinds);
}

template <class V>
void describe(V& v, CertifySection& s) {
  v.number(s.friction,
           {"friction", "friction coefficient mu between tool and body", kOptional, kNotNegative});
  v.texts(s.devices, {"devices", "device profiles (TOML) to certify, relative to the case"});
}

}  // namespace palpate::app
