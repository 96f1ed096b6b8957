// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/position_text.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(PositionText, IsInTheUnitOfTheFile) {
  const Vec3 x{0.0125, 0, -1.439125};
  EXPECT_EQ(position_text(x), "(12.5, 0, -1439.12) mm");
  print_positions_in(unit_of_length(0.1));
  EXPECT_EQ(position_text(x), "(0.125, 0, -14.3912) dm");
  print_positions_in(unit_of_length(1));
  EXPECT_EQ(position_text(x), "(0.0125, 0, -1.43912) m");
  print_positions_in(unit_of_length(1e-3));
  EXPECT_EQ(position_text(x), "(12.5, 0, -1439.12) mm");
}

TEST(PositionText, KnowsEveryUnitOfCaseFiles) {
  for (const Unit& unit : units_of(Dimension::Length))
    EXPECT_EQ(unit_of_length(unit.si).si, unit.si) << unit.symbol;
  EXPECT_EQ(unit_of_length(0.0254 / 72).symbol, "mm");  // points of a printer
}

}  // namespace
}  // namespace palpate
