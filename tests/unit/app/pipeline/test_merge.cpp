// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/stages.hpp"
#include "format/error.hpp"
#include "tests/unit/app/pipeline/stage_workspace.hpp"

namespace palpate::app {
namespace {

using ::testing::HasSubstr;

class Merge : public ::testing::Test {
 protected:
  std::filesystem::path write_part(int index, const Curves& curves) {
    Workspace part = files_.space;
    part.shard = {index, 2};
    write_curves(part.precomputed(), curves);
    return part.precomputed();
  }
  std::filesystem::path write_shard(int index) {
    return write_part(index, files_.failed_curves(sites_of_shard(files_.body, {index, 2})));
  }
  SiteCounts merge(std::vector<std::filesystem::path> parts = {}) {
    return run_merge(files_.space, std::move(parts),
                     [this](const Event& e) { events_.push_back(e); });
  }
  std::string message(std::vector<std::filesystem::path> parts = {}) {
    try {
      merge(std::move(parts));
    } catch (const Error& error) {
      return error.what();
    }
    return "merged";
  }

  StageWorkspace files_;
  std::vector<Event> events_;
};

TEST_F(Merge, JoinsThePartsInOrderOfVertex) {
  write_shard(1);
  write_shard(2);
  const SiteCounts counts = merge();
  const Curves curves = read_curves(files_.space.curves());
  EXPECT_EQ(counts.failed, sites_of(files_.body).size());
  ASSERT_EQ(curves.sites.size(), counts.failed);
  for (std::size_t i = 0; i < curves.sites.size(); ++i)
    EXPECT_EQ(curves.sites[i].vertex, sites_of(files_.body)[i]);
  ASSERT_EQ(events_.size(), 1U);
  const auto& event = std::get<MergeFinished>(events_.front());
  EXPECT_EQ(event.parts, 2U);
  EXPECT_EQ(event.sites, counts.failed);
  EXPECT_EQ(stale_reason(files_.space, Stage::Precompute, curves.provenance), "");
}

TEST_F(Merge, RejectsAFolderWithoutParts) {
  EXPECT_THAT(message(), HasSubstr("contains no curves.I-of-N.h5"));
}

TEST_F(Merge, RejectsMissingAndRepeatedSites) {
  const auto first = write_shard(1);
  EXPECT_THAT(message({first}), HasSubstr("none of the parts"));
  EXPECT_THAT(message({first, first}), HasSubstr("as well"));
}

TEST_F(Merge, RejectsPartsOfAnotherBodyOrCase) {
  write_shard(1);
  Curves other = files_.failed_curves(sites_of_shard(files_.body, {2, 2}));
  other.body_sha256 = std::string(64, 'b');
  write_part(2, other);
  EXPECT_THAT(message(), HasSubstr("computed on another body"));
  write_shard(2);
  files_.space.c.campaign.indentation.increments += 1;
  EXPECT_THAT(message(), HasSubstr("the case has changed"));
}

}  // namespace
}  // namespace palpate::app
