// SPDX-License-Identifier: AGPL-3.0-or-later
// The error of the mesh as a stage of the campaign.
#include "app/pipeline/mesh_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/pipeline/settings.hpp"
#include "fitting/response/mesh_error.hpp"
#include "tests/unit/app/pipeline/stage_workspace.hpp"

namespace palpate::app {
namespace {

using ::testing::HasSubstr;

class MeshErrorStage : public ::testing::Test {
 protected:
  /// The facts; the events are kept.
  auto estimate(const fem::CampaignSettings& settings) {
    return estimate_mesh_error(files_.space, files_.body, settings, curves_, nullptr,
                               [this](const Event& e) { events_.push_back(e); });
  }

  StageWorkspace files_;
  Curves curves_;
  std::vector<Event> events_;
};

TEST_F(MeshErrorStage, PressesNothingWhereItIsNotWanted) {
  const fem::CampaignSettings settings = campaign_settings(files_.space);
  EXPECT_EQ(settings.mesh_error_sites, 0);
  EXPECT_TRUE(estimate(settings).empty());
  EXPECT_TRUE(events_.empty());
}

TEST_F(MeshErrorStage, SaysWhyTheErrorStaysUnknown) {
  fem::CampaignSettings settings = campaign_settings(files_.space);
  settings.mesh_error_sites = 4;
  settings.dilatation = fem::Dilatation::LinearNodal;
  EXPECT_TRUE(estimate(settings).empty());
  ASSERT_EQ(events_.size(), 1U);
  EXPECT_THAT(std::get<LogLine>(events_.front()).text,
              HasSubstr("stays unknown: elements cannot be refined under the tool with linear"));
}

TEST_F(MeshErrorStage, IsOneSentence) {
  EXPECT_EQ(mesh_error_text(curves_), "");
  SiteCurves site{3, SiteStatus::Complete, "", 1, {}};
  CurvePath path{PathKind::Normal, 0, {0, 0, -1}, {}};
  path.samples.resize(3);
  for (const std::size_t i : {1U, 2U}) {
    CurveSample& sample = path.samples[i];
    sample.displacement = 1e-3 * static_cast<double>(i);
    sample.force = {0, 0, -0.5 * static_cast<double>(i)};
    sample.facets_in_contact = static_cast<double>(i);
    sample.mesh_difference = 0.05;
  }
  site.paths.push_back(path);
  path.kind = PathKind::Lateral;
  path.direction = {0, 0, 1};
  for (const std::size_t i : {1U, 2U}) {
    path.samples[i].force = {0, 0, 0.5 * static_cast<double>(i)};
    path.samples[i].mesh_difference = 0.1;
  }
  site.paths.push_back(path);
  curves_.sites.push_back(site);
  fitting::bound_mesh_errors(curves_);
  EXPECT_THAT(mesh_error_text(curves_),
              HasSubstr("at most 10 % at the end of the path and 10 % at the first increment, "
                        "and 20 % of the lateral force (medians over the sites; 67 % "
                        "confidence)"));
}

}  // namespace
}  // namespace palpate::app
