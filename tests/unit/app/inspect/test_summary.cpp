// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/inspect/summary.hpp"
#include "format/numbers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "format/flat_library.hpp"
#include "format/site_fields.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

nlohmann::ordered_json summary_of(const Library& library) {
  const samples::TemporaryFolder folder;
  write_library(folder / "library.h5", library);
  return summarize_artifact(folder / "library.h5");
}

TEST(Inspect, GivesTheVerdictOfEachDevice) {
  const auto summary = summary_of(samples::library(4));
  const auto& devices = summary["certificate"]["devices"];
  ASSERT_EQ(devices.size(), 2u);
  EXPECT_EQ(devices[0]["verdict"],
            "certified passive from 637.5 Hz on, with slides rate-limited (Mahvash & Hayward 2005, "
            "eq. 5: "
            "850.0 Hz)");
  EXPECT_EQ(devices[0]["lowest_certified_rate"]["value"], 637.5);
  EXPECT_EQ(devices[1]["verdict"],
            "no guarantee: its damping, delay, dry friction, position resolution and force "
            "resolution are "
            "unknown");
  EXPECT_TRUE(devices[1]["damping"]["value"].is_null());
  const std::string text = summary_text(summary);
  EXPECT_LT(text.find("guarantee: guaranteed by the runtime"), text.find("certificate:"));
  EXPECT_THAT(text, HasSubstr("lowest certified rate: 637.5 Hz\n"));
  EXPECT_THAT(text, HasSubstr("damping: unknown\n"));
}

TEST(Inspect, StatesTheAccuracyOfALibraryBesideItsGuarantee) {
  Library library = samples::library(4);
  for (NodeResponse& node : library.responses)
    node.normal_mesh_error = node.lateral_mesh_error = 0.01;
  const auto summary = summary_of(library);
  EXPECT_EQ(summary["max_lateral_mesh_error"]["value"], 0.01);
  const std::string text = summary_text(summary);
  EXPECT_THAT(text, ContainsRegex("accuracy: at 95 % of the vertices the normal force is within "
                                  "[0-9.]+ % .mesh. . [0-9.]+ % .fit. of the converged force"));
}

TEST(Inspect, StatesHowMuchStifferDragsAreAcrossTheSoftAxes) {
  Library library = samples::coupled_library(4);
  EXPECT_FALSE(summary_of(library).contains("stiffness_across_over_along"));
  for (NodeResponse& node : library.responses) node.soft_axis = {0.3F, -0.4F, 0};
  library.responses.front().status = ResponseStatus::Hole;
  const auto quotient = summary_of(library)["stiffness_across_over_along"];
  EXPECT_NEAR(quotient["median"], 1 / (0.75 * 0.75), 1e-6);
  EXPECT_NEAR(quotient["max"], 1 / (0.75 * 0.75), 1e-6);
}

TEST(Inspect, CallsAnInfiniteBoundNoBound) {
  Library library = samples::library(4);
  library.certificate.slip = library.certificate.min_lipschitz_bound = kInfinity;
  library.certificate.devices[0].lowest_rate = kInfinity;
  const auto summary = summary_of(library);
  EXPECT_TRUE(summary["certificate"]["L_slip"]["value"].is_null());
  const std::string text = summary_text(summary);
  EXPECT_THAT(text, HasSubstr("L slip: no bound\n"));
  EXPECT_THAT(text, HasSubstr("verdict: no guarantee at any rate: slides have no bound\n"));
  EXPECT_THAT(text, HasSubstr("lowest certified rate: no bound\n"));
  EXPECT_THAT(text, Not(ContainsRegex("[^a-z](inf|nan)[^a-z]")));
}

TEST(Inspect, PrintsLengthsInMillimetresAndNamesOfFilesAsTheyAre) {
  const nlohmann::ordered_json summary = {
      {"tool_radius", {{"value", 0.012}, {"unit", "m"}}},
      {"volume", {{"value", 2e-6}, {"unit", "m^3"}}},
      {"bounding_box", {{"low", {-0.1, 0}}, {"high", {0.25, 1}}, {"unit", "m"}}},
      {"provenance", {{{"inputs", {{"my_liver.stl", "0f"}}}}}}};
  const std::string text = summary_text(summary);
  EXPECT_THAT(text, HasSubstr("tool radius: 12 mm\n"));
  EXPECT_THAT(text, HasSubstr("volume: 2 cm^3\n"));
  EXPECT_THAT(text, HasSubstr("  low: -100, 0\n  high: 250, 1000\n  unit: mm\n"));
  EXPECT_THAT(text, HasSubstr("my_liver.stl: 0f\n"));
}

TEST(Inspect, NamesTheSitesOfLargestContactErrors) {
  Curves curves;
  curves.tool = {"sphere", 0.005, "frictionless"};
  for (std::int32_t vertex = 3; vertex < 6; ++vertex) {
    SiteCurves site{vertex, SiteStatus::Complete, "", 1, {}};
    CurveSample sample;
    sample.force = {0, 0, -2};
    sample.strain_energy = 1e-3;
    sample.penetration = vertex == 4 ? 2e-5 : 1e-5;
    sample.contact_energy = vertex == 5 ? 4e-6 : 1e-6;
    sample.tension = vertex == 3 ? 0.5 : std::numeric_limits<double>::quiet_NaN();
    site.paths.push_back({PathKind::Normal, 0, {0, 0, -1}, {sample}});
    curves.sites.push_back(site);
  }
  const samples::TemporaryFolder folder;
  write_curves(folder / "curves.h5", curves);
  const auto contact = summarize_artifact(folder / "curves.h5")["contact"];
  EXPECT_EQ(contact["max_penetration"]["value"], 2e-5);
  EXPECT_EQ(contact["site_of_max_penetration"], 4);
  EXPECT_EQ(contact["max_contact_energy_over_strain_energy"], 4e-3);
  EXPECT_EQ(contact["site_of_max_contact_energy"], 5);
  EXPECT_EQ(contact["max_tension_over_force"], 0.25);
  EXPECT_EQ(contact["site_of_max_tension"], 3);
}

TEST(Inspect, SaysTheNumberThatTheFileHas) {
  const samples::TemporaryFolder folder;
  write_body(folder / "body.h5", samples::body(3));
  write_body(folder / "curved.h5", samples::curved_body(3));
  write_flat_library(folder / "library.plib", samples::library(4));
  EXPECT_EQ(summarize_artifact(folder / "body.h5")["schema"], 1);
  EXPECT_EQ(summarize_artifact(folder / "curved.h5")["schema"], 3);
  const auto flat = summarize_artifact(folder / "library.plib");
  std::ifstream file(folder / "library.plib", std::ios::binary);
  file.seekg(8);  // format/schema/flat.md
  EXPECT_EQ(flat["version"], file.get());
  EXPECT_FALSE(flat.contains("schema"));
}

TEST(Inspect, SaysWhatTheFieldsOfASiteAreOf) {
  SiteFields fields;
  fields.vertex = 7;
  fields.normal = {{1e-3, std::vector<float>(12, 1e-4F)}, {2e-3, std::vector<float>(12, 2e-4F)}};
  fields.lateral = {{2e-3, {1, 0, 0}, 1e-3, std::vector<float>(12, 1e-4F)}};
  const samples::TemporaryFolder folder;
  write_site_fields(folder / "site-7.fields", fields);
  const auto summary = summarize_artifact(folder / "site-7.fields");
  EXPECT_EQ(summary["response_vertex"], 7);
  EXPECT_EQ(summary["skin_vertices"], 4);
  EXPECT_EQ(summary["depths"]["values"], std::vector<double>({1e-3, 2e-3}));
  EXPECT_EQ(summary["depths_of_drags"]["values"], std::vector<double>({2e-3}));
}

TEST(Inspect, HasTheErrorOfTheMesh) {
  Curves curves;
  curves.tool = {"sphere", 0.005, "frictionless"};
  SiteCurves site{3, SiteStatus::Complete, "", 1, {}};
  std::vector<CurveSample> samples(3);
  for (const std::size_t i : {1U, 2U}) {
    samples[i].displacement = 1e-3 * static_cast<double>(i);
    samples[i].force = {0, 0, -static_cast<double>(i)};
    samples[i].mesh_error = 0.1;
  }
  site.paths.push_back({PathKind::Normal, 0, {0, 0, -1}, samples});
  curves.sites.push_back(site);
  const samples::TemporaryFolder folder;
  write_curves(folder / "curves.h5", curves);
  EXPECT_EQ(summarize_artifact(folder / "curves.h5")["mesh_error"], "unknown");
  curves.mesh_error_confidence = 0.95;
  write_curves(folder / "curves.h5", curves);
  const auto error = summarize_artifact(folder / "curves.h5")["mesh_error"];
  EXPECT_NEAR(error["max_at_end_of_press"].get<double>(), 0.05, 1e-12);
  EXPECT_NEAR(error["median_at_first_sample"].get<double>(), 0.1, 1e-12);
  EXPECT_EQ(error["confidence"], 0.95);
}

TEST(Inspect, CountsThePathsWhoseEnergyDoesNotBalance) {
  Curves curves;
  curves.tool = {"sphere", 0.005, "frictionless"};
  for (std::int32_t vertex = 3; vertex < 7; ++vertex) {
    SiteCurves site{vertex, SiteStatus::Complete, "", 1, {}};
    CurveSample sample;
    sample.strain_energy = 0.9e-3;
    sample.contact_energy = vertex == 6 ? std::numeric_limits<double>::quiet_NaN() : 0.1e-3;
    sample.tool_work = vertex == 3 ? 1.004e-3 : vertex == 4 ? 0.98e-3 : 1.006e-3;
    site.paths.push_back({PathKind::Normal, 0, {0, 0, -1}, {sample}});
    curves.sites.push_back(site);
  }
  const samples::TemporaryFolder folder;
  write_curves(folder / "curves.h5", curves);
  const auto energy = summarize_artifact(folder / "curves.h5")["energy"];
  EXPECT_NEAR(energy["max_imbalance"].get<double>(), 0.02, 1e-12);
  EXPECT_EQ(energy["site_of_max_imbalance"], 4);
  EXPECT_EQ(energy["paths_with_balance"], 3);
  EXPECT_EQ(energy["paths_off_by_more_than_half_a_percent"], 2);
}

}  // namespace
}  // namespace palpate::app
