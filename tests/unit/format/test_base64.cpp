// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/base64.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Base64, IsThatOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Base64, ReadsWhatItWrites) {
  std::string bytes;
  for (int i = 0; i < 300; ++i) {
    EXPECT_EQ(from_base64(base64(bytes)), bytes);
    bytes += static_cast<char>(31 * i);
  }
}

TEST(Base64, RefusesOtherCharactersAndMissingPadding) {
  for (const char* text :
       {"Zg", "Zg=", "Zg===", "Z===", "Zm9v=Zg=", "Zg==Zg==", "Z*==", "Zm 9", "===="})
    EXPECT_EQ(from_base64(text), std::nullopt) << text;
}

}  // namespace
}  // namespace palpate
