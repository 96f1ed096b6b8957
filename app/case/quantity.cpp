// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/quantity.hpp"

#include <array>
#include <charconv>
#include <numbers>
#include <system_error>

namespace palpate::app {
namespace {

constexpr std::array kLength{Unit{"mm", 1e-3}, Unit{"cm", 1e-2},   Unit{"dm", 1e-1},
                             Unit{"um", 1e-6}, Unit{"in", 0.0254}, Unit{"m", 1}};
constexpr std::array kPressure{Unit{"kPa", 1e3}, Unit{"MPa", 1e6}, Unit{"Pa", 1}};
constexpr std::array kAngle{Unit{"deg", std::numbers::pi / 180}, Unit{"rad", 1}};
constexpr std::array kForce{Unit{"mN", 1e-3}, Unit{"N", 1}};
constexpr std::array kFrequency{Unit{"kHz", 1e3}, Unit{"Hz", 1}};
constexpr std::array kMass{Unit{"g", 1e-3}, Unit{"kg", 1}};
constexpr std::array kDamping{Unit{"N s/m", 1}};
constexpr std::array kStiffness{Unit{"N/m", 1}};
constexpr std::array kSpeed{Unit{"mm/s", 1e-3}, Unit{"cm/s", 1e-2}, Unit{"m/s", 1}};
constexpr std::array kTime{Unit{"ms", 1e-3}, Unit{"us", 1e-6}, Unit{"s", 1}};
constexpr std::array kCompliance{Unit{"mm/N", 1e-3}, Unit{"um/N", 1e-6}, Unit{"m/N", 1}};

constexpr std::array kFoundationStiffness{Unit{"kPa/mm", 1e6}, Unit{"N/mm^3", 1e9},
                                          Unit{"N/m^3", 1}};

constexpr std::array kAcceleration{Unit{"m/s^2", 1}};
constexpr std::array kDensity{Unit{"g/cm^3", 1e3}, Unit{"kg/m^3", 1}};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

}  // namespace

std::string_view dimension_name(Dimension dimension) {
  switch (dimension) {
    case Dimension::Length:
      return "length";
    case Dimension::Pressure:
      return "pressure";
    case Dimension::Angle:
      return "angle";
    case Dimension::Force:
      return "force";
    case Dimension::Frequency:
      return "frequency";
    case Dimension::Mass:
      return "mass";
    case Dimension::Damping:
      return "viscous damping";
    case Dimension::Stiffness:
      return "stiffness";
    case Dimension::Speed:
      return "speed";
    case Dimension::Time:
      return "time";
    case Dimension::Compliance:
      return "compliance";
    case Dimension::FoundationStiffness:
      return "stiffness per area";
    case Dimension::Acceleration:
      return "acceleration";
    case Dimension::Density:
      return "density";
  }
  return "";
}

std::span<const Unit> units_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::Length:
      return kLength;
    case Dimension::Pressure:
      return kPressure;
    case Dimension::Angle:
      return kAngle;
    case Dimension::Force:
      return kForce;
    case Dimension::Frequency:
      return kFrequency;
    case Dimension::Mass:
      return kMass;
    case Dimension::Damping:
      return kDamping;
    case Dimension::Stiffness:
      return kStiffness;
    case Dimension::Speed:
      return kSpeed;
    case Dimension::Time:
      return kTime;
    case Dimension::Compliance:
      return kCompliance;
    case Dimension::FoundationStiffness:
      return kFoundationStiffness;
    case Dimension::Acceleration:
      return kAcceleration;
    case Dimension::Density:
      return kDensity;
  }
  return {};
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

ParsedQuantity parse_quantity(std::string_view text, Dimension dimension) {
  const std::string_view body = trimmed(text);
  double number = 0;
  const auto [end, failure] = std::from_chars(body.data(), body.data() + body.size(), number);
  if (failure != std::errc{}) return {0, QuantityFault::NoNumber};
  const auto used = static_cast<std::size_t>(end - body.data());
  const std::string_view symbol = trimmed(body.substr(used));
  if (symbol.empty()) return {0, QuantityFault::NoUnit};
  for (const Unit& unit : units_of(dimension)) {
    if (unit.symbol == symbol) return {number * unit.si, QuantityFault::None};
  }
  return {0, QuantityFault::WrongUnit};
}

std::string print_quantity(double value, Dimension dimension) {
  const std::span<const Unit> units = units_of(dimension);
  for (const Unit& unit : {units.front(), units.back()}) {
    const double scaled = value / unit.si;
    if (scaled * unit.si == value) return shortest(scaled) + " " + std::string(unit.symbol);
  }
  return shortest(value) + " " + std::string(units.back().symbol);
}

std::string print_number(double value) {
  std::string text = shortest(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace palpate::app
