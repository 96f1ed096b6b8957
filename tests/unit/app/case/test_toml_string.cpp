// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/toml_string.hpp"

#include <gtest/gtest.h>

#include <toml++/toml.h>

#include <string>

namespace palpate::app {
namespace {

TEST(TomlString, IsReadBackByAParserOfToml) {
  for (const std::string text :
       {"liver.stl", "a \"quoted\" name", "C:\\organs\\liver", "line\nline", "Röhre\t\x01\x7f"}) {
    const toml::table table = toml::parse("key = " + toml_string(text));
    EXPECT_EQ(table["key"].value_or(std::string()), text);
  }
}

}  // namespace
}  // namespace palpate::app
