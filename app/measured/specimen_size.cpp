// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/specimen_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "fitting/measurement/records/record_units.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

/// "120 mm^2" in m^2.
double area_of(const std::string& text, const std::string& where) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  std::string unit(end);
  unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
  if (end != text.c_str() && value > 0 && std::isfinite(value) && unit.ends_with("^2")) {
    const auto length = measured::unit_in_si(unit.substr(0, unit.size() - 2), Dimension::Length);
    if (length) return value * *length * *length;
  }
  refuse(where, "'" + text + "' is not an area with its unit", "write for example \"120 mm^2\"");
}

}  // namespace

bool has_section_keys(const SpecimenSize& size) {
  return !size.area.empty() || std::isfinite(size.width) || std::isfinite(size.thickness) ||
         std::isfinite(size.diameter);
}

double section_area(const SpecimenSize& size, const std::string& where) {
  const bool rectangle = std::isfinite(size.width) && std::isfinite(size.thickness);
  const int given =
      (size.area.empty() ? 0 : 1) + (rectangle ? 1 : 0) + (std::isfinite(size.diameter) ? 1 : 0);
  if (given != 1)
    refuse(where, "a force needs the section of the specimen, once",
           "give area, or width and thickness, or diameter");
  if (!size.area.empty()) return area_of(size.area, where);
  if (rectangle) return size.width * size.thickness;
  return std::numbers::pi / 4 * size.diameter * size.diameter;
}

std::string area_text(double square_metres) {
  constexpr double kSquareMillimetre = 1e-6, kSquareMicrometre = 1e-12;
  if (square_metres < 1e-2 * kSquareMillimetre)
    return fmt::format("{:.4g} um^2", square_metres / kSquareMicrometre);
  return fmt::format("{:.4g} mm^2", square_metres / kSquareMillimetre);
}

}  // namespace palpate::app
