// SPDX-License-Identifier: AGPL-3.0-or-later
// The section of a material: its law, the constants of the law, its fibres.
#pragma once

#include <numbers>
#include <string>
#include <string_view>

#include "app/case/case.hpp"
#include "app/case/describe/key.hpp"
#include "app/case/describe/series.hpp"
#include "fem/laws/law_table.hpp"

namespace palpate::app {

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
void describe_relaxation(V& v, MaterialSection& s) {
  describe_series(v, s.relaxation,
                  {"relaxation",
                   "Prony series of the isochoric stress, in ascending order of time; the "
                   "volumetric stress is elastic"},
                  "part of the instantaneous isochoric stress that relaxes; their sum is below 1");
  const bool relaxes = !s.relaxation.empty();
  if (v.has_section("moduli", relaxes) || relaxes)
    describe_choice(
        v, s.moduli,
        {"moduli",
         "with `relaxation`: whether the constants of the law are those at once after a "
         "step of strain or those in the long term",
         kRequired},
        kModuli);
}

/// The law and its constants, which alone say what the tissue is.
template <class V>
void describe_law(V& v, MaterialSection& s) {
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
void describe(V& v, MaterialSection& s) {
  v.text(s.region, {"region", "region of the body; empty means that of the outer surface"});
  v.quantity(s.density, Dimension::Density,
             {"density", "reference density, for the weight; 0: that of `[gravity]`", kOptional,
              kNotNegative});
  describe_relaxation(v, s);
  describe_law(v, s);
}

}  // namespace palpate::app
