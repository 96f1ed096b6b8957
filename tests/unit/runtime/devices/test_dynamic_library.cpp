// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/devices/dynamic_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/error.hpp"

namespace palpate::test {
namespace {

using runtime::DynamicLibrary;
using testing::HasSubstr;

TEST(DynamicLibrary, BindsAFunctionOfTheFirstLibraryThatExists) {
  const DynamicLibrary library({"libabsent.so.1", "libm.so.6"}, "the vendor", "install it");
  double (*cosine)(double) = nullptr;
  library.bind(cosine, "cos");
  ASSERT_NE(cosine, nullptr);
  EXPECT_EQ(cosine(0.0), 1.0);
}

TEST(DynamicLibrary, WithoutALibraryNamesTheOwnerTheFilesAndTheRemedy) {
  try {
    const DynamicLibrary library({"libabsent.so.1", "libmissing.so"}, "the vendor", "install it");
    FAIL() << "was loaded";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_EQ(error.where(), "the vendor");
    EXPECT_THAT(error.problem(), HasSubstr("libabsent.so.1"));
    EXPECT_THAT(error.problem(), HasSubstr("libmissing.so"));
    EXPECT_EQ(error.remedy(), "install it");
  }
}

TEST(DynamicLibrary, NamesAFunctionThatTheLibraryDoesNotHave) {
  const DynamicLibrary library({"libm.so.6"}, "the vendor", "install it");
  double (*absent)(double) = nullptr;
  try {
    library.bind(absent, "no_such_function");
    FAIL() << "was bound";
  } catch (const Error& error) {
    EXPECT_THAT(error.problem(), HasSubstr("no_such_function"));
  }
}

}  // namespace
}  // namespace palpate::test
