// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/c_boundary.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <new>
#include <stdexcept>

namespace palpate::test {
namespace {

using runtime::give;
using runtime::guarded;

TEST(Guarded, PassesOnTheResultOfTheAction) {
  EXPECT_EQ(guarded(PALPATE_ERROR_FORMAT, [] { return static_cast<int>(PALPATE_OK); }), PALPATE_OK);
}

TEST(Guarded, TurnsExceptionsIntoAStatusAndAMessage) {
  EXPECT_EQ(guarded(PALPATE_ERROR_FORMAT, []() -> int { throw std::runtime_error("broken"); }),
            PALPATE_ERROR_FORMAT);
  EXPECT_STREQ(palpate_last_error(), "broken");
  EXPECT_EQ(guarded(PALPATE_ERROR_FORMAT, []() -> int { throw std::bad_alloc(); }),
            PALPATE_ERROR_MEMORY);
  EXPECT_STREQ(palpate_last_error(), "out of memory");
  EXPECT_EQ(guarded(PALPATE_ERROR_ARGUMENT, []() -> int { throw 1; }), PALPATE_ERROR_ARGUMENT);
  EXPECT_STREQ(palpate_last_error(), "unknown failure");
}

TEST(Give, CopiesTheFieldsThatBothHeadersKnow) {
  struct Fields {
    std::uint32_t size;
    std::uint32_t first, second;
  };
  const Fields whole{sizeof(Fields), 1, 2};
  Fields older{offsetof(Fields, second), 0, 42};
  give(whole, &older, older.size);
  EXPECT_EQ(older.size, offsetof(Fields, second));
  EXPECT_EQ(older.first, 1U);
  EXPECT_EQ(older.second, 42U);
  Fields newer{sizeof(Fields) + 8, 0, 0};
  give(whole, &newer, newer.size);
  EXPECT_EQ(newer.size, sizeof(Fields) + 8);
  EXPECT_EQ(newer.second, 2U);
}

}  // namespace
}  // namespace palpate::test
