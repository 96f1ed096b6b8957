// SPDX-License-Identifier: AGPL-3.0-or-later
// The size of a specimen, by which a machine or a reader turns travel into strain and force into
// stress.
#pragma once

#include <limits>
#include <string>

#include "app/case/describe/case.hpp"

namespace palpate::app {

/// Keys of a specimen, as they are written: one section of three ways to give it.
struct SpecimenSize {
  double gauge_length = std::numeric_limits<double>::quiet_NaN();  ///< m
  std::string area;                                                ///< "120 mm^2"
  double width = std::numeric_limits<double>::quiet_NaN();         ///< m
  double thickness = std::numeric_limits<double>::quiet_NaN();     ///< m
  double diameter = std::numeric_limits<double>::quiet_NaN();      ///< m
};

/// Section of the specimen, m^2.
/// @throws Error(Configuration) at `where` unless the section is given once, with its unit.
double section_area(const SpecimenSize& size, const std::string& where);

/// Whether any key of the section is given.
bool has_section_keys(const SpecimenSize& size);

/// "12.57 mm^2", in the unit of length that fits.
std::string area_text(double square_metres);

template <class V>
void describe_specimen(V& v, SpecimenSize& s) {
  v.quantity(s.gauge_length, Dimension::Length,
             {"gauge_length", "length that the travel deforms; height of a shear specimen",
              kOptional, kPositive});
  v.text(s.area, {"area", "of the section, with its unit"});
  v.quantity(s.width, Dimension::Length, {"width", "of the section", kOptional, kPositive});
  v.quantity(s.thickness, Dimension::Length, {"thickness", "of the section", kOptional, kPositive});
  v.quantity(s.diameter, Dimension::Length,
             {"diameter", "of a round section", kOptional, kPositive});
}

}  // namespace palpate::app
