// SPDX-License-Identifier: AGPL-3.0-or-later
// The sinks by themselves: every event as text and as JSON, and the page that lists its keys.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "app/pipeline/describe_events.hpp"
#include "app/pipeline/json_sink.hpp"
#include "app/pipeline/text_sink.hpp"
#include "format/numbers.hpp"
#include "tests/support/source_folder.hpp"

namespace palpate::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::json;

/// What a text sink prints on the standard output and the standard error, as a terminal shows them.
std::string text_of(const std::vector<Event>& events, bool terminal = false,
                    Verbosity verbosity = Verbosity::Normal) {
  std::string shown;
  const TextOutput output{[&](std::string_view text) { shown += text; }, terminal};
  TextSink sink({output, output, verbosity});
  for (const Event& event : events) sink(event);
  return shown;
}

Json json_of(const Event& event) {
  std::string out;
  const JsonSink sink([&](std::string_view line) { out += line; });
  sink(event);
  EXPECT_EQ(out.find('\n'), std::string::npos);
  return Json::parse(out);
}

SamplingRound sampling_round() {
  SamplingRound round;
  round.number = 2;
  round.sites = 13;
  round.of_sites = 88;
  round.leave_one_out = 0.05;
  round.along.states = 40;
  round.along.p95 = 0.038;
  round.whole.p95 = 0.04;
  round.whole.median = 0.013;
  return round;
}

Certified certified() {
  Certified event;
  event.guarantee = "guaranteed by the runtime";
  event.friction = 0.3;
  event.stick_bound = 150.26;
  event.slip_bound = kInfinity;
  event.min_enforceable_bound = 160.01;
  event.enforced_bound = 170;
  event.limited_by = "a slide in triangle 7";
  event.devices = {{"pen", "passive from 900 Hz on"}};
  event.file = "out/library.h5";
  return event;
}

StiffnessAtRate stiffness(double certifiable, double library, double enforceable) {
  StiffnessAtRate event{"pen", 1000, certifiable, library, enforceable, 3, 20, 7};
  event.certifiable_by_friction = kInfinity;
  event.published_stiffness = 0.75 * certifiable;
  if (std::isnan(certifiable)) event.unknown = {"damping"};
  return event;
}

TEST(TextSink, PrintsTheStagesOfABuild) {
  EXPECT_EQ(
      text_of({StageStarted{"mesh", "out/body.h5", "missing"}, LogLine{"mesh", "remeshed"},
               MeshFinished{10, 20, 30, 5, "out/body.h5"}, StageUpToDate{"fit", "out/library.h5"},
               FitFinished{4, 1, 2, {0.004, 0.1, 7}, {0.02, 0.5, 3}, {0.03, 0.6, 3}, "l.h5"},
               FileWritten{"convergence", "c.csv"}, Warning{"precompute", "careful"}}),
      "mesh: creating out/body.h5 (missing)\n"
      "  remeshed\n"
      "mesh: 10 nodes, 20 tetrahedra, 30 response triangles, 5 sites -> out/body.h5\n"
      "fit: out/library.h5 is up to date\n"
      "  error of the fit over the largest force of a site: normal 0.40 % median, 10 % worst "
      "(site 7)\n"
      "    lateral 2.0 % median, 50 % worst (site 3); to any single path 3.0 % median, 60 % "
      "worst (site 3)\n"
      "fit: 4 responses fitted, 1 interpolated, 2 holes -> l.h5\n"
      "convergence: c.csv\n"
      "warning: careful\n");
}

TEST(TextSink, PrintsTheErrorOfTheMeshWhereItIsKnown) {
  FitFinished event{4, 0, 0, {0.004, 0.1, 7}, {0.02, 0.5, 3}, {0.03, 0.6, 3}, "l.h5"};
  event.mesh = {0.01, 0.02, 5};
  event.lateral_mesh = {0.03, 0.04, 6};
  event.accuracy = "within 2.0 %";
  const std::string text = text_of({event});
  EXPECT_THAT(text, HasSubstr("error of the mesh in the normal force, at most 1.0 % median, 2.0 % "
                              "worst (site 5)\n    in the lateral force 3.0 % median, 4.0 % worst "
                              "(site 6)\n  accuracy: within 2.0 %\n"));
}

TEST(TextSink, SendsWarningsToTheStandardError) {
  std::string out, err;
  TextSink sink({{[&](std::string_view text) { out += text; }},
                 {[&](std::string_view text) { err += text; }}});
  sink(LogLine{"mesh", "remeshed"});
  sink(Warning{"mesh", "a hole was filled"});
  sink(SamplingFinished{false, "all points are sites"});
  EXPECT_EQ(out, "  remeshed\n");
  EXPECT_EQ(err, "warning: a hole was filled\nwarning: all points are sites\n");
}

TEST(TextSink, PrintsOnlyWarningsWhenQuietAndEverySiteWhenVerbose) {
  const std::vector<Event> events{LogLine{"mesh", "remeshed"}, Warning{"mesh", "a hole was filled"},
                                  SiteFinished{7, SiteStatus::Partial, "contact was lost", 1.5},
                                  Progress{10, 1, 0, 10, 0, {}}};
  EXPECT_EQ(text_of(events, false, Verbosity::Quiet), "warning: a hole was filled\n");
  EXPECT_EQ(text_of(events, false, Verbosity::Verbose),
            "  remeshed\nwarning: a hole was filled\n"
            "  site 7: stopped early, 1.5 s CPU time: contact was lost\n"
            "precompute: 10 of 10 sites, 1 incomplete, 0 s\n");
}

/// What leads to them is silenced, and so are stages that write files.
TEST(TextSink, PrintsResultsThatWereAskedForWhenQuiet) {
  const std::vector<Event> results{
      stiffness(200, 100, 90),
      stiffness(95, 100, 90),
      stiffness(45, 100, 90),
      stiffness(80, 100, kInfinity),
      stiffness(NAN, 100, 90),
      SteepestForce{"sticking", 90, 100, 3, 0.95, 400},
      SteepestForce{"sliding", 0, 0, -1, 0, 0},
      ChallengeVerdict{"certify", "the search confirms the certificate"},
      Estimate{104, true, 8240, 24720, 113, 12, 2, 1.24e9, 158e3, 8}};
  const std::string loud = text_of(results);
  EXPECT_THAT(loud, HasSubstr("\n  the search confirms the certificate\n"));
  std::vector<Event> all{StageStarted{"certify", "out/library.h5", "missing"}};
  all.insert(all.end(), results.begin(), results.end());
  all.push_back(certified());
  all.push_back(Softened{4, 80, 0.01, 0.1, 0.2, "s.h5"});
  EXPECT_EQ(text_of(all, false, Verbosity::Quiet), loud);
}

TEST(TextSink, StartsALineForAWarningWhereABarIsOpen) {
  const std::string shown = text_of({CampaignStarted{}, Progress{0, 0, 2, 10, 0, {}},
                                     Progress{10, 0, 0, 10, 0, {}}, Warning{"fit", "w"}},
                                    true);
  EXPECT_TRUE(shown.ends_with("0 s\x1b[K\nwarning: w\n")) << shown;
}

TEST(TextSink, PrintsWhatACampaignContinues) {
  EXPECT_EQ(text_of({CampaignStarted{"Haswell", 0, 0, false, "o/c.journal"}}),
            "  BLAS kernel: Haswell\n");
  const std::string text = text_of({CampaignStarted{"Haswell", 32, 9, true, "o/c.journal"}});
  EXPECT_THAT(text, HasSubstr("moved to c.journal.old"));
  EXPECT_THAT(text, HasSubstr("32 finished sites found in o/c.journal"));
  EXPECT_THAT(text, HasSubstr("(9 bytes)"));
}

TEST(TextSink, ListsTheFirstIncompleteSites) {
  CampaignFinished event{{1, 1, 6}, 65, 3605, "curves.h5", {}};
  for (int vertex = 0; vertex < 7; ++vertex)
    event.incomplete.push_back(
        {vertex, vertex == 0 ? SiteStatus::Partial : SiteStatus::Failed, "a reason", 1});
  const std::string text = text_of({event});
  EXPECT_THAT(text, HasSubstr("1 site complete, 1 stopped early, 6 failed, 1 min 05 s (1 h 00 min "
                              "CPU time) -> curves.h5"));
  EXPECT_THAT(text, HasSubstr("site 0 stopped early: a reason"));
  EXPECT_THAT(text, HasSubstr("site 4 failed: a reason"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("site 5")));
  EXPECT_THAT(text, HasSubstr("and 2 more"));
  event.incomplete.clear();
  EXPECT_THAT(text_of({event}), ::testing::Not(HasSubstr("more")));
}

TEST(TextSink, PrintsProgressByLineAndByBar) {
  const Progress done{10, 1, 0, 10, 0, {}}, half{5, 0, 2, 10, 0, {}};
  EXPECT_THAT(text_of({half}), IsEmpty());  // too soon after the start for a line
  EXPECT_THAT(text_of({done}), HasSubstr("precompute: 10 of 10 sites, 1 incomplete, 0 s\n"));
  const std::string bar = text_of({done}, true);
  EXPECT_THAT(bar, HasSubstr("\r[##############################] precompute: 10 of 10"));
  EXPECT_TRUE(bar.ends_with("\n"));
  EXPECT_THAT(text_of({SiteFinished{}}), IsEmpty());
}

/// Each step takes seconds on a large body, before any site begins.
TEST(TextSink, TellsTheStepsBeforeTheFirstSite) {
  std::string shown;
  const TextOutput output{[&](std::string_view text) { shown += text; }, true};
  TextSink sink({output, output, Verbosity::Normal});
  sink(PreloadStep{1, 0, 0});
  EXPECT_THAT(shown, IsEmpty());
  std::this_thread::sleep_for(std::chrono::milliseconds(250));  // progress is shown so often
  sink(PreloadStep{12, 0.5, 0});
  EXPECT_THAT(shown, HasSubstr("\rprecompute: equilibrium under the weight, step 12, 50 % of the "
                               "weight reached\x1b[K"));
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  sink(PreloadStep{30, 0, 4});
  EXPECT_THAT(shown, HasSubstr("\rprecompute: shape without weight, step 30, 4 shapes tried"));
  EXPECT_THAT(text_of({PreloadStep{1, 0, 0}}), IsEmpty());  // a line every ten seconds
}

/// The estimate of the time left begins anew, and so does the bar.
TEST(TextSink, TellsTheProgressOnTheFinerMeshApart) {
  const std::string shown =
      text_of({Progress{10, 0, 0, 10, 0, {}}, FinerMeshProgress{{0, 0, 4, 4, 0, {}}},
               FinerMeshProgress{{4, 0, 0, 4, 0, {}}}});
  EXPECT_THAT(shown, HasSubstr("precompute: 10 of 10 sites, 0 incomplete, 0 s\n"));
  EXPECT_THAT(shown, HasSubstr("precompute, finer mesh: 4 of 4 sites, 0 incomplete, 0 s\n"));
}

/// Long before the first site of a batch is finished the bar moves.
TEST(TextSink, MovesTheBarWithTheIncrementsOfSites) {
  const Progress start{0, 0, 0, 10, 0, {}}, half{9, 0, 1, 10, 0, {{7, 0.6}}, true};
  std::string shown;
  const TextOutput output{[&](std::string_view text) { shown += text; }, true};
  TextSink sink({output, output, Verbosity::Normal});
  sink(start);
  std::this_thread::sleep_for(std::chrono::milliseconds(250));  // bars are shown so often
  sink(half);
  EXPECT_THAT(shown, HasSubstr("[#############################.] precompute: 9 of 10 sites"));
  EXPECT_THAT(text_of({start, half}), IsEmpty());
}

TEST(TextSink, BreaksLinesToTheWidthOfATerminal) {
  std::string shown;
  const TextOutput output{[&](std::string_view text) { shown += text; }, true, 30};
  TextSink sink({output, output, Verbosity::Normal});
  sink(LogLine{"mesh", "a line that is wider than thirty columns"});
  sink(Warning{"mesh", "a warning that is wider than thirty columns"});
  EXPECT_EQ(shown,
            "  a line that is wider than\n    thirty columns\n"
            "warning: a warning that is\n  wider than thirty columns\n");
}

TEST(TextSink, PrintsAdaptiveSampling) {
  EXPECT_EQ(text_of({sampling_round(), SamplingFinished{false, "all points are sites"}}),
            "  round 2: 13 of 88 sites; 95th-percentile error at hold-out points: 3.8 % along the "
            "press, 4.0 % as vectors (median 1.3 %)\n"
            "warning: all points are sites\n");
  EXPECT_EQ(text_of({SamplingFinished{true, "met"}}), "  met\n");
}

TEST(TextSink, PrintsTheCertificateAndBoundsThatDoNotExist) {
  EXPECT_EQ(
      text_of({certified()}),
      "certify: guaranteed by the runtime\n"
      "  pen: passive from 900 Hz on\n"
      "  L_stick: 150.3 N/m at a fixed contact point, L_slip: no bound while sliding, at mu = "
      "0.3\n"
      "  smallest enforceable bound L_min: 160.1 N/m; the runtime enforces 170.0 N/m\n"
      "  limited by: a slide in triangle 7\n"
      "certify: out/library.h5\n");
  Certified no_device = certified();
  no_device.devices.clear();
  EXPECT_THAT(text_of({no_device}), HasSubstr("no rate is guaranteed on any device"));
}

TEST(TextSink, PrintsTheCertifiableStiffnessAndItsRemedies) {
  EXPECT_THAT(text_of({stiffness(NAN, 100, 90)}), HasSubstr("its damping is unknown"));
  StiffnessAtRate coarse = stiffness(200, 100, 90);
  coarse.certifiable_by_friction = 50;
  EXPECT_THAT(text_of({coarse}), HasSubstr("its dry friction certifies 50.00 N/m"));
  coarse.unknown = {"delay", "dry friction"};
  EXPECT_THAT(text_of({coarse}), HasSubstr("no guarantee: its delay and dry friction are unknown"));
  EXPECT_THAT(text_of({coarse}), Not(HasSubstr("is certified")));
  EXPECT_THAT(text_of({stiffness(200, 100, 90)}), HasSubstr("2005, eq. 5: 150.0 N/m"));
  EXPECT_THAT(text_of({stiffness(200, 100, 90)}), HasSubstr("2.00 times its forces"));
  EXPECT_THAT(text_of({stiffness(95, 100, 90)}), HasSubstr("rate-limited to 90.00 N/m"));
  EXPECT_THAT(text_of({stiffness(80, 100, kInfinity)}), HasSubstr("no bound can be enforced"));
  EXPECT_THAT(text_of({stiffness(45, 100, 90)}),
              HasSubstr("3 of 20 triangles exceed it, most of all triangle 7"));
  EXPECT_THAT(text_of({stiffness(45, 100, 90)}), HasSubstr("0.50 times its forces"));
  EXPECT_THAT(text_of({Softened{0, kInfinity, 0, 0, 0, "s.h5"}}), HasSubstr("no response had to"));
  EXPECT_THAT(text_of({Softened{4, 80, 0.01, 0.1, 0.2, "s.h5"}}),
              HasSubstr("median 1.0 %, 95th percentile 10.0 %, largest 20.0 %"));
}

TEST(TextSink, PrintsSearchesAndStudies) {
  EXPECT_THAT(text_of({SteepestForce{"sliding", 0, 0, -1, 0, 0}}), HasSubstr("nothing to search"));
  EXPECT_THAT(text_of({SteepestForce{"sticking", 90, 100, 3, 0.95, 400}}),
              HasSubstr("90.00 N/m in triangle 3, 0.90 of the bound"));
  EXPECT_THAT(text_of({SteepestForce{"sliding", 90, kInfinity, 3, 0.95, 400}}),
              HasSubstr("there is no bound"));
  EXPECT_THAT(text_of({ConvergenceLevel{0.004, 12000, 61}}),
              HasSubstr("elements of 4.00 mm, 12000 unknowns, 1 min 01 s"));
  EXPECT_THAT(text_of({ConvergenceOfForce{5, "normal", {0.1, 0.09}, true, 1.5, 0.08, 0.25, 0.3}}),
              HasSubstr("100.0 90.00 -> 80.00 mN, order 1.50; error of the case's mesh +25.0 %, at "
                        "most 30.0 %"));
  EXPECT_THAT(text_of({ConvergenceOfForce{5, "normal", {1e-7, 9e-8}, true, 1.5, 8e-8, 0.25, 0.3}}),
              HasSubstr("0.1000 0.09000 -> 0.08000 uN, order 1.50"));
  EXPECT_THAT(text_of({ConvergenceOfForce{5, "normal", {0.1, 0.09}, false, NAN, 0.09, 0.1, 0.4}}),
              HasSubstr("no power of the element size; error of the case's mesh +10.0 %, at most "
                        "40.0 %"));
  EXPECT_THAT(
      text_of({Estimate{104, true, 8240, 24720, 113, 12, 2, 1.24e9, 158e3, 8, 20}}),
      testing::AllOf(HasSubstr("at most 104 sites on 8240 nodes (24720 unknowns) take 1 min 53 s"),
                     HasSubstr("memory 1.2 GB, library.h5 0.16 MB"),
                     HasSubstr("8 trial sites in 20 s; nothing was written")));
  EXPECT_THAT(text_of({MergeFinished{9, 3, {9, 0, 0}, "c.h5"}}),
              HasSubstr("9 sites of 3 parts, 9 complete"));
}

TEST(JsonSink, WritesOneObjectForEachEvent) {
  EXPECT_EQ(json_of(CampaignStarted{"Haswell", 3, 0, false, "c.journal"}),
            Json::parse(R"({"event": "start", "blas_kernel": "Haswell", "known_sites": 3,
                            "dropped_bytes": 0, "moved_aside": false})"));
  EXPECT_EQ(json_of(PreloadStep{12, 0.5, 0}),
            Json::parse(R"({"event": "preload", "steps": 12, "carried": 0.5, "shapes": 0})"));
  EXPECT_EQ(json_of(SiteFinished{7, SiteStatus::Partial, "line search failed", 1.5}),
            Json::parse(R"({"event": "site", "vertex": 7, "status": "partial",
                            "reason": "line search failed", "cpu_seconds": 1.5})"));
  EXPECT_EQ(json_of(Progress{4, 1, 2, 10, 3, {}}),
            Json::parse(R"({"event": "progress", "done": 4, "failed": 1, "running": 2,
                            "total": 10})"));
  EXPECT_EQ(json_of(CampaignFinished{{8, 1, 1}, 2, 3.5, "curves.h5", {}}),
            Json::parse(R"({"event": "end", "complete": 8, "partial": 1, "failed": 1,
                            "seconds": 2.0, "cpu_seconds": 3.5, "file": "curves.h5"})"));
}

TEST(JsonSink, WritesProgressAfterSitesAlone) {
  std::string out;
  const JsonSink sink([&](std::string_view line) { out += line; });
  Progress between{4, 0, 2, 10, 0, {{7, 0.5}, {9, 0.25}}, true};
  sink(between);
  EXPECT_THAT(out, IsEmpty());
  between.between_sites = false;
  sink(between);
  EXPECT_THAT(out, HasSubstr("progress"));
  out.clear();
  sink(FinerMeshProgress{{0, 0, 2, 4, 0, {{7, 0.5}}, true}});
  EXPECT_THAT(out, IsEmpty());
  EXPECT_EQ(json_of(FinerMeshProgress{{1, 0, 2, 4, 0, {}}}),
            Json::parse(R"({"event": "finer_mesh", "done": 1, "total": 4})"));
}

TEST(JsonSink, WritesErrorsOfARoundAsObjects) {
  const Json round = json_of(sampling_round());
  EXPECT_EQ(round["event"], "round");
  EXPECT_EQ(round["error_along_press"]["p95"], 0.038);
  EXPECT_EQ(round["error_of_vector"]["median"], 0.013);
  EXPECT_EQ(round["hold_out_states"], 40);
}

TEST(JsonSink, WritesNullForNumbersThatAreNotFinite) {
  const Json event = json_of(certified());
  EXPECT_TRUE(event["L_slip"].is_null());
  EXPECT_EQ(event["L_stick"], 150.26);
  EXPECT_EQ(event["devices"]["pen"], "passive from 900 Hz on");
  EXPECT_TRUE(json_of(stiffness(NAN, 1, 1))["certifiable_stiffness"].is_null());
}

TEST(Console, DurationsAreShort) {
  EXPECT_EQ(duration_text(41.6), "42 s");
  EXPECT_EQ(duration_text(187), "3 min 07 s");
  EXPECT_EQ(duration_text(8100), "2 h 15 min");
  EXPECT_EQ(duration_text(-1), "0 s");
}

/// Set PALPATE_UPDATE_DOCS=1 to rewrite the tables of the page.
TEST(EventReference, IsThatOfThePage) {
  const std::string path = (test::source_folder() / "docs/campaigns.md").string();
  std::ostringstream page;
  page << std::ifstream(path).rdbuf();
  const std::string begin = "<!-- events: begin -->\n";
  const std::string text = page.str();
  const auto first = text.find(begin);
  const auto last = text.find("<!-- events: end -->");
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(last, std::string::npos);
  const std::string expected =
      text.substr(0, first + begin.size()) + event_reference() + text.substr(last);
  if (std::getenv("PALPATE_UPDATE_DOCS") != nullptr) std::ofstream(path) << expected;
  EXPECT_EQ(text, expected) << "run this test once with PALPATE_UPDATE_DOCS=1";
}

}  // namespace
}  // namespace palpate::app
