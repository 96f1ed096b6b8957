// SPDX-License-Identifier: AGPL-3.0-or-later
// Which library a word of the command line means.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "app/play/shipped.hpp"
#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& file, const std::string& text = "") {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

class Shipped : public ::testing::Test {
 protected:
  Shipped() {
    put(folder.path() / "cases" / "soft.toml",
        "# SPDX-License-Identifier: CC0-1.0\n# A pad of gel,\n# soft. It is 2 cm thick.\n"
        "name = \"soft\"\n# Not this. Nor this.\n");
    put(libraries / "soft.plib");
    put(libraries / "hard.plib");
    put(libraries / "README.md");
  }
  samples::TemporaryFolder folder;
  fs::path libraries = folder.path() / "libraries";
};

TEST_F(Shipped, AreListedByNameWithTheFirstSentenceOfTheirCase) {
  const auto list = shipped_libraries(libraries);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].name, "hard");
  EXPECT_EQ(list[0].about, "");
  EXPECT_EQ(list[1].name, "soft");
  EXPECT_EQ(list[1].file, libraries / "soft.plib");
  EXPECT_EQ(list[1].about, "A pad of gel, soft.");
}

TEST_F(Shipped, AreNoneWhereThereIsNoFolder) {
  EXPECT_TRUE(shipped_libraries(folder.path() / "nowhere").empty());
}

TEST_F(Shipped, NameStandsBeforeFolderOfThatName) {
  const fs::path here = fs::current_path();
  put(folder.path() / "soft" / "library.h5");
  fs::current_path(folder.path());
  EXPECT_EQ(chosen_library("soft", libraries), libraries / "soft.plib");
  EXPECT_EQ(chosen_library("./soft", libraries), fs::path("./soft/library.h5"));
  fs::current_path(here);
}

TEST_F(Shipped, FolderStandsForItsLibraryAndTheHdf5FileComesFirst) {
  const fs::path out = folder.path() / "out";
  put(out / "library.plib");
  EXPECT_EQ(chosen_library(out.string(), libraries), out / "library.plib");
  put(out / "library.h5");
  EXPECT_EQ(chosen_library(out.string(), libraries), out / "library.h5");
  EXPECT_EQ(chosen_library((out / "library.plib").string(), libraries), out / "library.plib");
}

TEST_F(Shipped, WhatIsNeitherIsRefusedWithTheNames) {
  fs::create_directories(folder.path() / "empty");
  for (const std::string& word : {std::string("liver"), (folder.path() / "empty").string()}) {
    try {
      chosen_library(word, libraries);
      FAIL() << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      if (word == "liver") {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("hard, soft"));
      }
    }
  }
}

}  // namespace
}  // namespace palpate::app
