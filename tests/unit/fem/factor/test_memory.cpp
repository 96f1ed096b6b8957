// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/error.hpp"

namespace palpate::fem {
namespace {

constexpr double kEach = 1e12;  // beside which the resident memory is negligible

TEST(Memory, FitsAsOftenAsTheBoundAllows) {
  EXPECT_EQ(fitting_times(0, kEach, 7, "a site"), 7);
  EXPECT_EQ(fitting_times(3.5 * kEach, kEach, 7, "a site"), 3);
  EXPECT_EQ(fitting_times(30.5 * kEach, kEach, 7, "a site"), 7);
  EXPECT_EQ(fitting_times(3.5 * kEach, kEach, 7, "a site", 2 * kEach), 1);
}

TEST(Memory, RefusesABoundThatIsTooSmall) {
  try {
    fitting_times(1.5 * kEach, kEach, 7, "a site", kEach);
    FAIL() << "it does not fit";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_THAT(error.what(), testing::HasSubstr("a site needs 1000000 MB"));
    EXPECT_THAT(error.what(), testing::HasSubstr("reserved"));
  }
}

TEST(Memory, OfAFactorizationLimitsItsThreads) {
  const auto bytes = [](int threads) { return (1 + threads) * kEach; };
  EXPECT_EQ(threads_that_fit({0, 4}, bytes), 4);
  EXPECT_EQ(threads_that_fit({10 * kEach, 4}, bytes), 4);
  EXPECT_EQ(threads_that_fit({4.5 * kEach, 4}, bytes), 3);
  EXPECT_EQ(threads_that_fit({2.5 * kEach, 4}, bytes), 1);
  EXPECT_THROW(threads_that_fit({1.5 * kEach, 4}, bytes), Error);
}

TEST(Memory, OfTheProcessIsNotZero) {
  EXPECT_GT(resident_bytes(), 1e5);
}

TEST(Memory, ErrorNamesTheNumberOfUnknowns) {
  try {
    out_of_memory(123456);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Internal);
    EXPECT_THAT(error.what(), testing::HasSubstr("123456 unknowns"));
  }
}

}  // namespace
}  // namespace palpate::fem
