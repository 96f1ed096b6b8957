// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "fitting/measurement/records/record_units.hpp"

namespace palpate::measured {
namespace {

TEST(RecordUnits, AreThoseOfLaboratories) {
  EXPECT_NEAR(*unit_in_si("lbf", Dimension::Force), 4.4482216152605, 1e-12);
  EXPECT_NEAR(*unit_in_si("kgf", Dimension::Force), 9.80665, 1e-12);
  EXPECT_NEAR(*unit_in_si("psi", Dimension::Pressure), 6894.757293168, 1e-6);
  for (const char* micro : {"um", "\xC2\xB5m", "\xCE\xBCm", "\xB5m"}) {
    EXPECT_NEAR(*unit_in_si(micro, Dimension::Length), 1e-6, 1e-18);
  }
  EXPECT_FALSE(unit_in_si("N", Dimension::Length));
}

TEST(RecordUnits, IncludeThoseOfCases) {
  for (const Dimension dimension : {Dimension::Length, Dimension::Force, Dimension::Pressure}) {
    for (const Unit& unit : units_of(dimension)) {
      EXPECT_EQ(unit_in_si(unit.symbol, dimension), unit.si) << unit.symbol;
      EXPECT_TRUE(is_record_unit(unit.symbol)) << unit.symbol;
    }
  }
  EXPECT_TRUE(is_record_unit(" degC "));
  EXPECT_FALSE(is_record_unit("furlong"));
  EXPECT_EQ(record_unit_list(Dimension::Ratio), "1, -, %, mm/mm, m/m");
}

}  // namespace
}  // namespace palpate::measured
