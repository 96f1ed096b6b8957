// SPDX-License-Identifier: AGPL-3.0-or-later
// Every unit against its definition.
#include "format/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

namespace palpate {
namespace {

constexpr Dimension kAll[] = {
    Dimension::Length,       Dimension::Pressure,   Dimension::Angle,
    Dimension::Force,        Dimension::Frequency,  Dimension::Mass,
    Dimension::Damping,      Dimension::Stiffness,  Dimension::Speed,
    Dimension::Time,         Dimension::Compliance, Dimension::FoundationStiffness,
    Dimension::Acceleration, Dimension::Density,    Dimension::Energy};

/// Values by the definitions of the units and the prefixes: an inch is 25.4 mm, a pound force
/// 0.45359237 kg at 9.80665 m/s^2.
const std::map<std::string, double> kDefined{{"m", 1},
                                             {"dm", 1e-1},
                                             {"cm", 1e-2},
                                             {"mm", 1e-3},
                                             {"um", 1e-6},
                                             {"nm", 1e-9},
                                             {"in", 0.0254},
                                             {"Pa", 1},
                                             {"kPa", 1e3},
                                             {"MPa", 1e6},
                                             {"N/mm^2", 1e6},
                                             {"kgf/cm^2", 9.80665 / 1e-4},
                                             {"rad", 1},
                                             {"deg", 2 * std::numbers::pi / 360},
                                             {"N", 1},
                                             {"mN", 1e-3},
                                             {"uN", 1e-6},
                                             {"nN", 1e-9},
                                             {"kN", 1e3},
                                             {"gf", 9.80665e-3},
                                             {"kgf", 9.80665},
                                             {"lbf", 0.45359237 * 9.80665},
                                             {"psi", 0.45359237 * 9.80665 / (0.0254 * 0.0254)},
                                             {"Hz", 1},
                                             {"kHz", 1e3},
                                             {"kg", 1},
                                             {"g", 1e-3},
                                             {"J", 1},
                                             {"mJ", 1e-3},
                                             {"uJ", 1e-6},
                                             {"N s/m", 1},
                                             {"N/m", 1},
                                             {"m/s", 1},
                                             {"um/s", 1e-6},
                                             {"mm/min", 1e-3 / 60},
                                             {"cm/s", 1e-2},
                                             {"mm/s", 1e-3},
                                             {"s", 1},
                                             {"sec", 1},
                                             {"ms", 1e-3},
                                             {"us", 1e-6},
                                             {"ns", 1e-9},
                                             {"min", 60},
                                             {"h", 3600},
                                             {"m/N", 1},
                                             {"mm/N", 1e-3},
                                             {"um/N", 1e-6},
                                             {"um/mN", 1e-6 / 1e-3},
                                             {"nm/uN", 1e-9 / 1e-6},
                                             {"um/uN", 1},
                                             {"N/m^3", 1},
                                             {"N/mm^3", 1e9},
                                             {"kPa/mm", 1e6},
                                             {"m/s^2", 1},
                                             {"kg/m^3", 1},
                                             {"g/cm^3", 1e3}};

TEST(Units, HaveTheValuesOfTheirDefinitions) {
  for (const Dimension dimension : kAll)
    for (const auto& units : {units_of(dimension), record_units_of(dimension)})
      for (const Unit& unit : units) {
        const auto defined = kDefined.find(std::string(unit.symbol));
        if (defined == kDefined.end()) {
          // The spellings of the micro sign; nothing else may be missing here.
          EXPECT_GE(static_cast<unsigned char>(unit.symbol[0]), 0x80) << unit.symbol;
          EXPECT_DOUBLE_EQ(unit.si, 1e-6) << unit.symbol;
        } else {
          EXPECT_DOUBLE_EQ(unit.si, defined->second) << unit.symbol;
        }
      }
}

TEST(Units, OfCaseFilesEndWithTheSiUnitAndAreUnitsOfRecordsToo) {
  for (const Dimension dimension : kAll) {
    const auto units = units_of(dimension);
    ASSERT_FALSE(units.empty()) << dimension_name(dimension);
    EXPECT_EQ(units.back().si, 1) << dimension_name(dimension);
    EXPECT_EQ(unit_symbols(dimension).size(), units.size());
    std::set<std::string_view> symbols, of_records;
    for (const Unit& unit : units) EXPECT_TRUE(symbols.insert(unit.symbol).second) << unit.symbol;
    for (const Unit& unit : record_units_of(dimension)) of_records.insert(unit.symbol);
    for (const std::string_view symbol : symbols) EXPECT_EQ(of_records.count(symbol), 1u) << symbol;
  }
}

TEST(Units, AreListedForMessages) {
  const auto symbols = unit_symbols(Dimension::Length);
  std::string expected;
  for (const std::string_view symbol : symbols)
    expected += (expected.empty() ? "" : ", ") + std::string(symbol);
  EXPECT_EQ(unit_list(Dimension::Length), expected);
  EXPECT_THAT(expected, testing::HasSubstr("mm"));
  EXPECT_TRUE(units_of(Dimension::Ratio).empty());
  EXPECT_EQ(dimension_name(Dimension::Length), "length");
}

}  // namespace
}  // namespace palpate
