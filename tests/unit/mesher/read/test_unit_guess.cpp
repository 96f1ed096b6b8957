// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/unit_guess.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace palpate::mesher {
namespace {

struct Organ {
  const char* name;
  double size;  // m, usual length in an adult
};

class OrganUnit : public testing::TestWithParam<Organ> {};

// Anatomy: liver 21 cm, brain 17 cm, lung 25 cm, heart 12 cm, kidney 11 cm, spleen 12 cm.
TEST_P(OrganUnit, IsGuessedFromItsSize) {
  for (const auto& [symbol, metres] : {std::pair("m", 1.0), std::pair("cm", 0.01),
                                       std::pair("mm", 0.001), std::pair("in", 0.0254)})
    EXPECT_EQ(guess_unit(GetParam().size / metres).likely.symbol, symbol) << GetParam().name;
}

INSTANTIATE_TEST_SUITE_P(Adult, OrganUnit,
                         testing::Values(Organ{"liver", 0.215}, Organ{"brain", 0.17},
                                         Organ{"heart", 0.12}, Organ{"kidney", 0.11},
                                         Organ{"spleen", 0.12}),
                         [](const auto& suite) { return std::string(suite.param.name); });

TEST(UnitGuess, NamesAnotherUnitWhereTheSizeLeavesAChoice) {
  const UnitGuess liver_in_inches = guess_unit(0.215 / 0.0254);  // 8.5 cm would do, too
  ASSERT_TRUE(liver_in_inches.another);
  EXPECT_EQ(liver_in_inches.another->symbol, "cm");
  EXPECT_FALSE(guess_unit(150).another);  // 150 mm; 1.5 m in centimetres
}

TEST(UnitGuess, CoversSmallSamplesAndTheLiverOfSofa) {
  EXPECT_EQ(guess_unit(5000).likely.symbol, "um");  // 5 mm; 5 m is no organ
  EXPECT_EQ(guess_unit(40).likely.symbol, "mm");
  EXPECT_EQ(guess_unit(2.15).likely.symbol, "dm");
}

TEST(StatedUnit, IsReadFromCommentsAndHeaders) {
  EXPECT_EQ(stated_unit("# 3ds Max Wavefront OBJ Exporter\n# File units = inches\n")->symbol, "in");
  EXPECT_EQ(stated_unit("3D Slicer output. SPACE=LPS")->symbol, "mm");
  EXPECT_EQ(stated_unit("ply\ncomment unit: centimeters\n")->symbol, "cm");
  EXPECT_EQ(stated_unit("COLOR= UNITS=mm")->symbol, "mm");
  EXPECT_EQ(stated_unit("# units: meters")->symbol, "m");
  EXPECT_EQ(stated_unit("the unit: units = mm")->symbol, "mm");
}

TEST(StatedUnit, IsNoneWhereTheFileSpeaksOfOtherThings) {
  EXPECT_FALSE(stated_unit("solid unit of the liver"));
  EXPECT_FALSE(stated_unit("solid united in mesh"));
  EXPECT_FALSE(stated_unit("<!-- a displacement of 0.5 units in the z direction -->"));
  EXPECT_EQ(stated_unit("0.5 units in z; units = in")->symbol, "in");
  EXPECT_FALSE(stated_unit(std::string(80, '\0')));
}

}  // namespace
}  // namespace palpate::mesher
