// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/error.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Error, IsOneLineOfPlaceProblemAndRemedy) {
  const Error error(ErrorKind::Geometry, "skin.off", "has a hole", "close it");
  EXPECT_STREQ(error.what(), "skin.off: has a hole; close it");
  EXPECT_EQ(error.kind(), ErrorKind::Geometry);
  EXPECT_EQ(error.where(), "skin.off");
  EXPECT_EQ(error.problem(), "has a hole");
  EXPECT_EQ(error.remedy(), "close it");
}

TEST(Refuse, ThrowsTheKindOfItsName) {
  try {
    refuse("case.toml:3", "unknown key", "remove it");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_STREQ(error.what(), "case.toml:3: unknown key; remove it");
  }
  try {
    refuse_geometry("skin.off", "has a hole", "close it");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
  }
}

}  // namespace
}  // namespace palpate
