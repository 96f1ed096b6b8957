// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/workspace.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCase = R"(name = "ball"
[surface]
file = "ball.off"
unit = "mm"
[[support]]
shape = "sphere"
centre = ["0 mm", "0 mm", "0 mm"]
radius = "1 mm"
[[material]]
young = "10 kPa"
poisson = 0.45
)";

fs::path write_case(const samples::TemporaryFolder& folder, const std::string& more = "") {
  std::ofstream(folder / "ball.toml") << kCase << more;
  return folder / "ball.toml";
}

TEST(Workspace, NamesTheArtifacts) {
  const samples::TemporaryFolder folder;
  const Workspace space = make_workspace(write_case(folder), "results", 3);
  EXPECT_EQ(space.case_folder, folder.path());
  EXPECT_EQ(space.threads, 3);
  EXPECT_EQ(space.body(), "results/body.h5");
  EXPECT_EQ(space.precomputed(), "results/curves.h5");
  EXPECT_EQ(space.journal(), "results/curves.journal");
  EXPECT_EQ(space.library(), "results/library.h5");
}

TEST(Workspace, AShardHasItsOwnCurvesAndJournal) {
  Workspace space;
  space.out = "results";
  space.shard = {2, 4};
  EXPECT_EQ(space.precomputed(), "results/curves.2-of-4.h5");
  EXPECT_EQ(space.journal(), "results/curves.2-of-4.journal");
  EXPECT_EQ(space.curves(), "results/curves.h5");
}

TEST(Workspace, TheOptionPrecedesTheCaseAndTheCaseTheDefault) {
  const samples::TemporaryFolder folder;
  EXPECT_EQ(make_workspace(write_case(folder), "", 1).out, "out/ball");
  const fs::path with_folder = write_case(folder, "[output]\nfolder = \"elsewhere\"\n");
  EXPECT_EQ(make_workspace(with_folder, "", 1).out, "elsewhere");
  EXPECT_EQ(make_workspace(with_folder, "given", 1).out, "given");
}

TEST(PrepareOutput, CreatesTheFolderOrNamesTheProblem) {
  const samples::TemporaryFolder folder;
  prepare_output(folder / "a" / "b");
  EXPECT_TRUE(fs::is_directory(folder / "a" / "b"));
  std::ofstream(folder / "file") << "not a folder";
  try {
    prepare_output(folder / "file" / "out");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("--out"));
  }
}

}  // namespace
}  // namespace palpate::app
