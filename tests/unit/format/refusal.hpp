// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "format/error.hpp"

namespace palpate::samples {

inline std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void expect_refusal(const std::function<void()>& action, ErrorKind kind,
                           const std::string& where, const std::string& problem) {
  try {
    action();
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_THAT(error.where(), testing::HasSubstr(where));
    EXPECT_THAT(error.problem(), testing::HasSubstr(problem));
    EXPECT_FALSE(error.remedy().empty());
  }
}

}  // namespace palpate::samples
