// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/freshness.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

class Freshness : public ::testing::Test {
 protected:
  Freshness() {
    std::ofstream(folder_ / "ball.toml") << R"([surface]
file = "ball.off"
unit = "mm"
[mesh]
patch_spacing = "8 mm"
[[support]]
shape = "sphere"
centre = ["0 mm", "0 mm", "0 mm"]
radius = "1 mm"
[[material]]
young = "10 kPa"
poisson = 0.45
)";
    write_surface("OFF");
    space_ = make_workspace(folder_ / "ball.toml", (folder_ / "out").string(), 1);
    made_.steps.push_back(make_stage_step(space_, Stage::Mesh, {{"a fact", "1"}}));
  }

  void write_surface(const char* text) const { std::ofstream(folder_ / "ball.off") << text; }

  samples::TemporaryFolder folder_;
  Workspace space_;
  Provenance made_;
};

TEST_F(Freshness, AnUnchangedArtifactIsUpToDate) {
  EXPECT_EQ(stale_reason(space_, Stage::Mesh, made_), "");
}

TEST_F(Freshness, AStageThatHasNotRunIsNamed) {
  EXPECT_EQ(stale_reason(space_, Stage::Fit, made_), "this stage has not run");
}

TEST_F(Freshness, OnlyTheSectionsOfTheStageMatter) {
  space_.c.certify.friction = 0.7;
  EXPECT_EQ(stale_reason(space_, Stage::Mesh, made_), "");
  space_.c.mesh.element_size *= 0.5;
  EXPECT_EQ(stale_reason(space_, Stage::Mesh, made_), "the case has changed");
}

TEST_F(Freshness, AChangedOrMissingInputIsFound) {
  write_surface("OFF again");
  EXPECT_EQ(stale_reason(space_, Stage::Mesh, made_), "an input file has changed");
  std::filesystem::remove(folder_ / "ball.off");
  EXPECT_EQ(stale_reason(space_, Stage::Mesh, made_), "an input file has changed");
}

TEST_F(Freshness, AnotherVersionIsNamed) {
  made_.steps.back().version = "0.0.0";
  EXPECT_EQ(stale_reason(space_, Stage::Mesh, made_), "it was made by version 0.0.0");
}

}  // namespace
}  // namespace palpate::app
