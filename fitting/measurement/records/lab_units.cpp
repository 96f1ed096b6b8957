// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/lab_units.hpp"

#include <algorithm>
#include <array>

namespace palpate::measured {
namespace {

struct LabUnit {
  std::string_view symbol;
  Quantity quantity;
  double si;
};

constexpr double kPoundForce = 4.4482216152605;  // N, exact by definition
constexpr double kInch = 0.0254;                 // m, exact by definition
constexpr double kGramForce = 9.80665e-3;        // N, exact by definition

// The micro sign of Latin-1 and of Unicode, and the Greek letter, all occur.
constexpr std::array kUnits{
    LabUnit{"s", Quantity::Time, 1},
    LabUnit{"sec", Quantity::Time, 1},
    LabUnit{"ms", Quantity::Time, 1e-3},
    LabUnit{"us", Quantity::Time, 1e-6},
    LabUnit{"ns", Quantity::Time, 1e-9},
    LabUnit{"min", Quantity::Time, 60},
    LabUnit{"h", Quantity::Time, 3600},
    LabUnit{"mm", Quantity::Length, 1e-3},
    LabUnit{"m", Quantity::Length, 1},
    LabUnit{"cm", Quantity::Length, 1e-2},
    LabUnit{"um", Quantity::Length, 1e-6},
    LabUnit{"\xC2\xB5m", Quantity::Length, 1e-6},
    LabUnit{"\xCE\xBCm", Quantity::Length, 1e-6},
    LabUnit{"\xB5m", Quantity::Length, 1e-6},
    LabUnit{"nm", Quantity::Length, 1e-9},
    LabUnit{"in", Quantity::Length, kInch},
    LabUnit{"N", Quantity::Force, 1},
    LabUnit{"mN", Quantity::Force, 1e-3},
    LabUnit{"kN", Quantity::Force, 1e3},
    LabUnit{"uN", Quantity::Force, 1e-6},
    LabUnit{"\xC2\xB5N", Quantity::Force, 1e-6},
    LabUnit{"\xCE\xBCN", Quantity::Force, 1e-6},
    LabUnit{"\xB5N", Quantity::Force, 1e-6},
    LabUnit{"gf", Quantity::Force, kGramForce},
    LabUnit{"kgf", Quantity::Force, 1e3 * kGramForce},
    LabUnit{"lbf", Quantity::Force, kPoundForce},
    LabUnit{"MPa", Quantity::Stress, 1e6},
    LabUnit{"kPa", Quantity::Stress, 1e3},
    LabUnit{"Pa", Quantity::Stress, 1},
    LabUnit{"psi", Quantity::Stress, kPoundForce / (kInch * kInch)},
    LabUnit{"kgf/cm^2", Quantity::Stress, 98066.5},
    LabUnit{"N/mm^2", Quantity::Stress, 1e6},
    LabUnit{"1", Quantity::Ratio, 1},
    LabUnit{"-", Quantity::Ratio, 1},
    LabUnit{"%", Quantity::Ratio, 1e-2},
    LabUnit{"mm/mm", Quantity::Ratio, 1},
    LabUnit{"m/m", Quantity::Ratio, 1},
};

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

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

std::string_view quantity_name(Quantity quantity) {
  switch (quantity) {
    case Quantity::Time:
      return "time";
    case Quantity::Length:
      return "length";
    case Quantity::Force:
      return "force";
    case Quantity::Stress:
      return "stress";
    case Quantity::Ratio:
      return "ratio";
  }
  return "";
}

std::optional<double> unit_in_si(std::string_view symbol, Quantity quantity) {
  for (const LabUnit& unit : kUnits) {
    if (unit.quantity == quantity && unit.symbol == trimmed(symbol)) return unit.si;
  }
  return std::nullopt;
}

bool is_lab_unit(std::string_view symbol) {
  const std::string_view wanted = trimmed(symbol);
  const auto is_it = [&](const LabUnit& unit) { return unit.symbol == wanted; };
  return std::any_of(kUnits.begin(), kUnits.end(), is_it) ||
         std::find(kOtherUnits.begin(), kOtherUnits.end(), wanted) != kOtherUnits.end();
}

std::string lab_unit_list(Quantity quantity) {
  std::string list;
  for (const LabUnit& unit : kUnits) {
    const bool plain = static_cast<unsigned char>(unit.symbol.front()) < 0x80;
    if (unit.quantity != quantity || !plain) continue;
    if (!list.empty()) list += ", ";
    list += unit.symbol;
  }
  return list;
}

}  // namespace palpate::measured
