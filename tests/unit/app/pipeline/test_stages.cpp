// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/error.hpp"
#include "tests/unit/app/pipeline/stage_workspace.hpp"

namespace palpate::app {
namespace {

using ::testing::HasSubstr;

const EventSink kIgnore = [](const Event&) {};

template <class Run>
std::string message_of(Run run) {
  try {
    run();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Stages, CountSitesByStatus) {
  const SiteCounts counts = count_sites(samples::curves(1));
  EXPECT_EQ(counts.complete, 12U);
  EXPECT_EQ(counts.partial, 4U);
  EXPECT_EQ(counts.failed, 4U);
  EXPECT_FALSE(counts.all_complete());
  EXPECT_TRUE(SiteCounts{}.all_complete());
  EXPECT_GE(counts.without_response, counts.failed);
  EXPECT_FALSE(counts.usable());
  EXPECT_TRUE((SiteCounts{236, 0, 2, 2}.usable()));
  EXPECT_TRUE((SiteCounts{19, 0, 1, 1}.usable()));
  EXPECT_FALSE((SiteCounts{18, 0, 1, 1}.usable()));
}

TEST(Stages, CountTheRecordsThatAnImportLeftOut) {
  Curves curves = samples::curves(1);
  EXPECT_EQ(count_sites(curves).refused, 0U);
  ProvenanceStep import = curves.provenance.steps.front();
  import.stage = "import";
  import.facts = {{"records", "61"}, { "refused", "2" }};
  curves.provenance.steps.push_back(import);
  EXPECT_EQ(count_sites(curves).refused, 2U);
  EXPECT_EQ(exit_code_of(SiteCounts{61, 0, 0, 0, 2}, false), kExitSomeSitesFailed);
}

TEST(Stages, AUsableLibrarySucceedsUnlessTheCallerIsStrict) {
  const SiteCounts all{238, 0, 0, 0}, two_missing{236, 2, 0, 2}, many_missing{200, 0, 38, 38};
  EXPECT_EQ(exit_code_of(all, true), kExitDone);
  EXPECT_EQ(exit_code_of(two_missing, false), kExitDone);
  EXPECT_EQ(exit_code_of(two_missing, true), kExitSomeSitesFailed);
  EXPECT_EQ(exit_code_of(many_missing, false), kExitSomeSitesFailed);
}

TEST(Stages, NameTheStageOfAMissingInput) {
  const StageWorkspace files;
  EXPECT_THAT(message_of([&] { run_fit(files.space, kIgnore); }), HasSubstr("palpate precompute"));
  EXPECT_THAT(message_of([&] { run_certify(files.space, kIgnore); }), HasSubstr("palpate fit"));
  EXPECT_THAT(message_of([&] { run_challenge(files.space, 1, kIgnore); }),
              HasSubstr("palpate certify"));
  std::filesystem::remove(files.space.body());
  EXPECT_THAT(message_of([&] { run_precompute(files.space, kIgnore); }), HasSubstr("palpate mesh"));
}

TEST(Stages, BuildRunsOnlyWhatIsOutOfDate) {
  const StageWorkspace files;
  std::vector<Event> events;
  run_build(files.space, Stage::Mesh, [&](const Event& e) { events.push_back(e); });
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(std::get<StageUpToDate>(events.front()).file, files.space.body());
  Workspace changed = files.space;
  changed.c.mesh.element_size *= 0.5;
  events.clear();
  // The surface of this case is not readable: the stage starts and fails.
  EXPECT_THROW(run_build(changed, Stage::Mesh, [&](const Event& e) { events.push_back(e); }),
               Error);
  ASSERT_GE(events.size(), 1U);
  EXPECT_EQ(std::get<StageStarted>(events.front()).reason, "the case has changed");
}

TEST(Stages, AFinishedShardIsUpToDate) {
  StageWorkspace files;
  files.space.shard = {1, 2};
  write_curves(files.space.precomputed(), files.failed_curves({0}));
  std::vector<Event> events;
  const SiteCounts counts =
      run_precompute(files.space, [&](const Event& e) { events.push_back(e); });
  EXPECT_EQ(counts.failed, 1U);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<StageUpToDate>(events.front()));
}

TEST(Stages, AdaptiveSamplingRejectsShards) {
  StageWorkspace files;
  files.space.c.sampling.method = SamplingMethod::Adaptive;
  files.space.shard = {1, 2};
  EXPECT_THAT(message_of([&] { run_precompute(files.space, kIgnore); }),
              HasSubstr("cannot be divided"));
}

TEST(Stages, TheCertifiableStiffnessNeedsADevice) {
  const StageWorkspace files;
  write_library(files.space.library(), samples::library(1));
  EXPECT_THAT(message_of([&] {
                run_certify_at_rate(files.space, {1000, {}, {}}, kIgnore);
              }),
              HasSubstr("--device"));
}

}  // namespace
}  // namespace palpate::app
