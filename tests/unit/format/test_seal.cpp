// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/seal.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "format/error.hpp"
#include "format/sha256.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

TEST(Seal, IsTheDigestOfTheContentOnALineOfItsOwn) {
  EXPECT_EQ(seal_of("content"), "\npalpate-sha256:" + sha256("content") + "\n");
  EXPECT_EQ(seal_of_digest(sha256("content")), seal_of("content"));
}

TEST(Seal, OfAnUnchangedFileIsAcceptedAsIsAFileWithoutOne) {
  const samples::TemporaryFolder folder;
  std::ofstream(folder / "sealed", std::ios::binary) << "content" << seal_of("content");
  EXPECT_NO_THROW(require_unbroken_seal(folder / "sealed", "make it again"));
  std::ofstream(folder / "unsealed", std::ios::binary) << std::string(500, 'x');
  EXPECT_NO_THROW(require_unbroken_seal(folder / "unsealed", "make it again"));
}

TEST(Seal, OfAChangedFileIsRefusedWithTheRemedy) {
  const samples::TemporaryFolder folder;
  std::ofstream(folder / "changed", std::ios::binary) << "c0ntent" << seal_of("content");
  try {
    require_unbroken_seal(folder / "changed", "make it again");
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_NE(error.remedy().find("make it again"), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate
