// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/hdf5_handle.hpp"

#include <gtest/gtest.h>

namespace palpate::hdf5 {
namespace {

int closed = 0;

herr_t count_close(hid_t) {
  ++closed;
  return 0;
}

TEST(Hdf5Handle, ClosesItsIdentifierOnceWhereverItMoves) {
  closed = 0;
  {
    Handle first(5, count_close);
    Handle second(std::move(first));
    EXPECT_EQ(second.get(), 5);
    Handle third;
    third = std::move(second);
    EXPECT_TRUE(third);
    third.reset();
    third.reset();
    EXPECT_FALSE(third);
  }
  EXPECT_EQ(closed, 1);
}

TEST(Hdf5Handle, GivesItsIdentifierAway) {
  closed = 0;
  { EXPECT_EQ(Handle(5, count_close).release(), 5); }
  { const Handle none(-1, count_close); }
  EXPECT_EQ(closed, 0);
}

TEST(Hdf5Handle, TypesOnDiskAreAsWideAsTheirNames) {
  for (const auto& [scalar, bytes] :
       {std::pair{Scalar::Float32, 4u}, std::pair{Scalar::Float64, 8u},
        std::pair{Scalar::Int32, 4u}, std::pair{Scalar::Int64, 8u}, std::pair{Scalar::UInt8, 1u},
        std::pair{Scalar::UInt32, 4u}}) {
    const std::string bits = std::to_string(8 * bytes) + "-bit";
    EXPECT_EQ(std::string(name_of(scalar)).rfind(bits, 0), 0u) << name_of(scalar);
    EXPECT_EQ(H5Tget_size(stored_type(scalar)), bytes);
    EXPECT_EQ(H5Tget_size(native_type(scalar)), bytes);
    if (bytes > 1) {
      EXPECT_EQ(H5Tget_order(stored_type(scalar)), H5T_ORDER_LE);
    }
  }
}

/// A hostile file must not move the cursor of a terminal.
TEST(Hdf5Handle, QuotesTextForATerminal) {
  EXPECT_EQ(quoted("metres"), "'metres'");
  EXPECT_EQ(quoted("a\x1b[2J\n\x7f"),
            "'a?[2J?"
            "?'");
  EXPECT_EQ(quoted("\xc3\xa9"), "'\xc3\xa9'");  // letters beyond ASCII are letters
  EXPECT_EQ(quoted(std::string(200, 'x')), "'" + std::string(80, 'x') + "...'");
}

TEST(Hdf5Handle, LastMessageIsOneLineOnWhatFailed) {
  const Session session;
  EXPECT_LT(H5Fopen("/no/such/file.h5", H5F_ACC_RDONLY, H5P_DEFAULT), 0);
  const std::string message = last_hdf5_message();
  EXPECT_NE(message.find("No such file"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace palpate::hdf5
