// SPDX-License-Identifier: Apache-2.0
// The units of the project: symbols and values in SI, of case files and of measured records.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// What a number with a unit measures.
enum class Dimension {
  Length,
  Pressure,
  Angle,
  Force,
  Frequency,
  Mass,
  Damping,
  Stiffness,
  Speed,
  Time,
  Compliance,
  FoundationStiffness,
  Acceleration,
  Density,
  Energy,
  Ratio
};

struct Unit {
  std::string_view symbol;
  double si;  ///< value of one unit in SI
};

std::string_view dimension_name(Dimension dimension);  ///< "length", ...

/// The units that case files may use. The first is the one used to print, the last is the SI unit.
/// None for Ratio, which case files write as plain numbers.
std::span<const Unit> units_of(Dimension dimension);
std::vector<std::string_view> unit_symbols(Dimension dimension);
std::string unit_list(Dimension dimension);  ///< "mm, cm, ...", for messages

/// The units that measured records may use: those of case files and others that laboratories write,
/// among them the spellings of the micro sign.
std::span<const Unit> record_units_of(Dimension dimension);

}  // namespace palpate
