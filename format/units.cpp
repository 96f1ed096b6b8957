// SPDX-License-Identifier: Apache-2.0
#include "format/units.hpp"

#include <array>
#include <numbers>

namespace palpate {
namespace {

constexpr double kPoundForce = 4.4482216152605;  // N, exact by definition
constexpr double kInch = 0.0254;                 // m, exact by definition
constexpr double kGramForce = 9.80665e-3;        // N, exact by definition

// Units of case files first, the SI unit last among them; then those of records alone. The micro
// sign of Latin-1 and of Unicode, and the Greek letter, all occur.
constexpr std::array kLength{Unit{"mm", 1e-3},   Unit{"cm", 1e-2},        Unit{"dm", 1e-1},
                             Unit{"um", 1e-6},   Unit{"nm", 1e-9},        Unit{"in", kInch},
                             Unit{"m", 1},       Unit{"\xC2\xB5m", 1e-6}, Unit{"\xCE\xBCm", 1e-6},
                             Unit{"\xB5m", 1e-6}};
constexpr std::array kPressure{
    Unit{"kPa", 1e3},          Unit{"MPa", 1e6},    Unit{"psi", kPoundForce / (kInch * kInch)},
    Unit{"kgf/cm^2", 98066.5}, Unit{"N/mm^2", 1e6}, Unit{"Pa", 1}};
constexpr std::array kAngle{Unit{"deg", std::numbers::pi / 180}, Unit{"rad", 1}};
constexpr std::array kForce{
    Unit{"mN", 1e-3},         Unit{"uN", 1e-6},       Unit{"nN", 1e-9},
    Unit{"kN", 1e3},          Unit{"gf", kGramForce}, Unit{"kgf", 1e3 * kGramForce},
    Unit{"lbf", kPoundForce}, Unit{"N", 1},           Unit{"\xC2\xB5N", 1e-6},
    Unit{"\xCE\xBCN", 1e-6},  Unit{"\xB5N", 1e-6}};
constexpr std::array kFrequency{Unit{"kHz", 1e3}, Unit{"Hz", 1}};
constexpr std::array kMass{Unit{"g", 1e-3}, Unit{"kg", 1}};
constexpr std::array kDamping{Unit{"N s/m", 1}};
constexpr std::array kStiffness{Unit{"N/m", 1}};
constexpr std::array kSpeed{Unit{"mm/s", 1e-3}, Unit{"um/s", 1e-6}, Unit{"mm/min", 1e-3 / 60},
                            Unit{"cm/s", 1e-2}, Unit{"m/s", 1}};
constexpr std::array kTime{Unit{"ms", 1e-3}, Unit{"us", 1e-6}, Unit{"ns", 1e-9}, Unit{"min", 60},
                           Unit{"h", 3600},  Unit{"s", 1},     Unit{"sec", 1}};
constexpr std::array kCompliance{Unit{"mm/N", 1e-3},  Unit{"um/N", 1e-6}, Unit{"um/mN", 1e-3},
                                 Unit{"nm/uN", 1e-3}, Unit{"um/uN", 1},   Unit{"m/N", 1}};
constexpr std::array kFoundationStiffness{Unit{"kPa/mm", 1e6}, Unit{"N/mm^3", 1e9},
                                          Unit{"N/m^3", 1}};
constexpr std::array kAcceleration{Unit{"m/s^2", 1}};
constexpr std::array kDensity{Unit{"g/cm^3", 1e3}, Unit{"kg/m^3", 1}};
constexpr std::array kEnergy{Unit{"mJ", 1e-3}, Unit{"uJ", 1e-6}, Unit{"J", 1}};
constexpr std::array kRatio{Unit{"1", 1}, Unit{"-", 1}, Unit{"%", 1e-2}, Unit{"mm/mm", 1},
                            Unit{"m/m", 1}};

struct Row {
  std::string_view name;
  std::span<const Unit> units;
  std::size_t in_cases;
};

constexpr Row all_in_cases(std::string_view name, std::span<const Unit> units) {
  return {name, units, units.size()};
}

Row row_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::Length:
      return {"length", kLength, 7};
    case Dimension::Pressure:
      return {"pressure", kPressure, 6};
    case Dimension::Angle:
      return all_in_cases("angle", kAngle);
    case Dimension::Force:
      return {"force", kForce, 8};
    case Dimension::Frequency:
      return all_in_cases("frequency", kFrequency);
    case Dimension::Mass:
      return all_in_cases("mass", kMass);
    case Dimension::Damping:
      return all_in_cases("viscous damping", kDamping);
    case Dimension::Stiffness:
      return all_in_cases("stiffness", kStiffness);
    case Dimension::Speed:
      return all_in_cases("speed", kSpeed);
    case Dimension::Time:
      return {"time", kTime, 6};
    case Dimension::Compliance:
      return all_in_cases("compliance", kCompliance);
    case Dimension::FoundationStiffness:
      return all_in_cases("stiffness per area", kFoundationStiffness);
    case Dimension::Acceleration:
      return all_in_cases("acceleration", kAcceleration);
    case Dimension::Energy:
      return all_in_cases("energy", kEnergy);
    case Dimension::Density:
      return all_in_cases("density", kDensity);
    case Dimension::Ratio:
      return {"ratio", kRatio, 0};
  }
  return {};
}

}  // namespace

std::string_view dimension_name(Dimension dimension) {
  return row_of(dimension).name;
}

std::span<const Unit> units_of(Dimension dimension) {
  const Row row = row_of(dimension);
  return row.units.first(row.in_cases);
}

std::span<const Unit> record_units_of(Dimension dimension) {
  return row_of(dimension).units;
}

std::vector<std::string_view> unit_symbols(Dimension dimension) {
  std::vector<std::string_view> symbols;
  for (const Unit& unit : units_of(dimension)) symbols.push_back(unit.symbol);
  return symbols;
}

std::string unit_list(Dimension dimension) {
  std::string list;
  for (const std::string_view symbol : unit_symbols(dimension)) {
    if (!list.empty()) list += ", ";
    list += symbol;
  }
  return list;
}

}  // namespace palpate
