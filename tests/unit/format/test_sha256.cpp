// SPDX-License-Identifier: AGPL-3.0-or-later
// Vectors of NIST: FIPS 180-4 examples and the SHA-2 example values.
#include "format/sha256.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

TEST(Sha256, StandardVectors) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmno"
                   "ijklmnopjklmnopqklmnopqrlmnopqrsmnopqrstnopqrstu"),
            "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// Around the block of 64 bytes the padding takes each of its forms; coreutils is the other voice.
TEST(Sha256, FileAgreesWithCoreutilsAtEveryLength) {
  const samples::TemporaryFolder folder;
  for (int length = 0; length <= 130; ++length) {
    const auto path = folder / "file";
    std::ofstream(path, std::ios::binary) << std::string(static_cast<std::size_t>(length), '\xe9');
    FILE* pipe = popen(("sha256sum " + path.string()).c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    char other[65] = {};
    ASSERT_EQ(fread(other, 1, 64, pipe), 64U);
    pclose(pipe);
    EXPECT_EQ(sha256_of_file(path), other) << length;
  }
}

TEST(Sha256, UnreadableFileIsAnError) {
  const samples::TemporaryFolder folder;
  EXPECT_THROW(sha256_of_file(folder / "absent"), Error);
  EXPECT_THROW(sha256_of_file(folder.path()), Error);
}

}  // namespace
}  // namespace palpate
