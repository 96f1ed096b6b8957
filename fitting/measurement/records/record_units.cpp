// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/record_units.hpp"

#include <algorithm>
#include <array>

#include "format/text.hpp"

namespace palpate::measured {
namespace {

/// The dimensions of the columns that palpate uses.
constexpr std::array kDimensions{Dimension::Time, Dimension::Length, Dimension::Force,
                                 Dimension::Pressure, Dimension::Ratio};

constexpr std::array<std::string_view, 15> kOtherUnits{"deg",
                                                       "rad",
                                                       "V",
                                                       "mV",
                                                       "A",
                                                       "degC",
                                                       "C",
                                                       "\xC2\xB0"
                                                       "C",
                                                       "K",
                                                       "Hz",
                                                       "mm/s",
                                                       "mm/min",
                                                       "N mm",
                                                       "N m",
                                                       "segments"};

}  // namespace

std::optional<double> unit_in_si(std::string_view symbol, Dimension dimension) {
  for (const Unit& unit : record_units_of(dimension)) {
    if (unit.symbol == trimmed(symbol)) return unit.si;
  }
  return std::nullopt;
}

bool is_record_unit(std::string_view symbol) {
  const auto has_it = [&](Dimension dimension) {
    return unit_in_si(symbol, dimension).has_value();
  };
  return std::any_of(kDimensions.begin(), kDimensions.end(), has_it) ||
         std::find(kOtherUnits.begin(), kOtherUnits.end(), trimmed(symbol)) != kOtherUnits.end();
}

std::string record_unit_list(Dimension dimension) {
  std::string list;
  for (const Unit& unit : record_units_of(dimension)) {
    const bool plain = static_cast<unsigned char>(unit.symbol.front()) < 0x80;
    if (!plain) continue;
    if (!list.empty()) list += ", ";
    list += unit.symbol;
  }
  return list;
}

}  // namespace palpate::measured
