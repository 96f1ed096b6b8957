// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "app/case/case.hpp"
#include "tests/support/source_folder.hpp"

namespace palpate::app {
namespace {

/// Set PALPATE_UPDATE_DOCS=1 to rewrite the tables of the page from the parser.
TEST(CaseReference, IsThatOfThePage) {
  const std::string path = (test::source_folder() / "docs/cases.md").string();
  std::ostringstream page;
  page << std::ifstream(path).rdbuf();
  const std::string begin = "<!-- keys: begin -->\n";
  const std::string end = "<!-- keys: end -->";
  const std::string text = page.str();
  const auto first = text.find(begin);
  const auto last = text.find(end);
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(last, std::string::npos);
  const std::string expected =
      text.substr(0, first + begin.size()) + case_reference() + text.substr(last);
  if (std::getenv("PALPATE_UPDATE_DOCS") != nullptr) std::ofstream(path) << expected;
  EXPECT_EQ(text, expected) << "run this test once with PALPATE_UPDATE_DOCS=1";
}

}  // namespace
}  // namespace palpate::app
