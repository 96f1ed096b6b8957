// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/bytes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

namespace palpate {
namespace {

const std::string kWhere = "a.journal";

ByteReader reader_of(std::string_view bytes) {
  return {bytes, kWhere, "is broken", "remove it"};
}

TEST(Bytes, ComeBackAsTheyWereWritten) {
  ByteWriter out;
  out.put(std::int32_t{-7});
  out.put(0.1);
  out.put(Vec3{1, 2, std::numeric_limits<double>::infinity()});
  out.put(std::string("te\0xt", 5));
  out.put(std::uint8_t{2});
  ByteReader in = reader_of(out.bytes);
  EXPECT_EQ(in.get<std::int32_t>(), -7);
  EXPECT_EQ(in.get<double>(), 0.1);
  EXPECT_EQ(in.vector(), (Vec3{1, 2, std::numeric_limits<double>::infinity()}));
  EXPECT_EQ(in.text(), std::string("te\0xt", 5));
  enum class Kind : std::uint8_t { First, Second, Third };
  EXPECT_EQ(in.one_of(Kind::Third), Kind::Third);
  EXPECT_TRUE(in.at_end());
  in.expect_end();
}

TEST(Bytes, AreLittleEndian) {
  ByteWriter out;
  out.put(std::uint32_t{0x04030201});
  EXPECT_EQ(out.bytes, "\x01\x02\x03\x04");
}

TEST(Bytes, ThatEndTooEarlyAreRefused) {
  ByteWriter out;
  out.put(std::string("text"));
  for (std::size_t length = 0; length < out.bytes.size(); ++length) {
    ByteReader in = reader_of(std::string_view(out.bytes).substr(0, length));
    EXPECT_THROW(in.text(), Error) << length;
  }
}

TEST(Bytes, RefuseACountThatCannotFitAndAnUnknownEnumerator) {
  ByteWriter out;
  out.put(std::uint32_t{1000});
  ByteReader in = reader_of(out.bytes);
  EXPECT_THROW(in.count(8), Error);
  enum class Kind : std::uint8_t { Only };
  ByteReader unknown = reader_of("\x01");
  EXPECT_THROW(unknown.one_of(Kind::Only), Error);
  EXPECT_THROW(reader_of("x").expect_end(), Error);
}

}  // namespace
}  // namespace palpate
