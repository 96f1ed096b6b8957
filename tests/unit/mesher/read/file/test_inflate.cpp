// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/file/inflate.hpp"

#include <zlib.h>

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

std::string packed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(out.data()), &size,
                     reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
            Z_OK);
  out.resize(size);
  return out;
}

TEST(Inflate, GivesBackTheBytes) {
  std::string bytes;
  for (unsigned i = 0; i < 100000; ++i) bytes += static_cast<char>(i * i / 7);
  const std::string stream = packed(bytes);
  EXPECT_EQ(inflate_exactly(stream, bytes.size(), "a"), bytes);
  EXPECT_EQ(inflate_exactly(stream, 1000, "a"), bytes.substr(0, 1000));
}

TEST(Inflate, ZerosNeedNoMoreThanTheBound) {
  const std::string bytes(1 << 20, '\0');
  const std::string stream = packed(bytes);
  EXPECT_LE(bytes.size(), most_inflated(stream.size()));
  EXPECT_EQ(inflate_exactly(stream, bytes.size(), "a"), bytes);
}

TEST(Inflate, RefusesDamageAndSizesThatCannotBe) {
  const std::string stream = packed("some bytes that are packed");
  expect_refusal([&] { inflate_exactly(stream, 1'000'000'000, "a.gz"); }, "a.gz", "cannot hold");
  expect_refusal([&] { inflate_exactly(stream, 1000, "a.gz"); }, "a.gz", "26 of 1000 bytes");
  expect_refusal([&] { inflate_exactly(stream.substr(0, 12), 26, "a.gz"); }, "a.gz", "of 26 bytes");
  expect_refusal([&] { inflate_exactly("no such stream", 5, "a.gz"); }, "a.gz", "damaged");
}

}  // namespace
}  // namespace palpate::mesher
