// SPDX-License-Identifier: AGPL-3.0-or-later
// write_sample_report <folder>: the reports that test_report_page.py opens in a browser.
// write_sample_report <folder> <patches> <refinements>: one of a lump of this size, for
// page_frames.py.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/report/play_page.hpp"
#include "app/report/preview.hpp"
#include "app/report/repair_file.hpp"
#include "app/report/report.hpp"
#include "format/numbers.hpp"
#include "tests/support/bodies.hpp"
#include "tests/unit/app/report/skins.hpp"
#include "tests/unit/app/report/synthetic.hpp"

namespace {

using palpate::operator-;

struct ComparedNode {
  std::int32_t vertex;
  double error;  ///< over that of a model 10 % too stiff
};

nlohmann::json comparison_of(const std::string& model) {
  using nlohmann::json;
  return {{"artifact", "palpate.comparison"},
          {"schema", 1},
          {"reference", "measured/curves.h5"},
          {"model", model},
          {"jnd", 0.07},
          {"jnd_floor_N", 0.005},
          {"summaries", json::array()},
          {"unmatched", {"site 3 of measured has no partner"}},
          {"curves", json::array()}};
}

/// What `palpate compare` writes of nodes: a normal curve 10 % too stiff with known uncertainty, a
/// lateral one about which nothing is known.
std::string comparison_of(const std::vector<ComparedNode>& nodes, const std::string& model) {
  using nlohmann::json;
  json all = comparison_of(model);
  for (const char* kind : {"normal", "lateral"}) {
    const bool known = std::string(kind) == "normal";
    json points = json::array();
    for (int i = 1; i <= 10; ++i) {
      points.push_back({{"displacement_m", 4e-4 * i},
                        {"reference_N", 0.1 * i},
                        {"model_N", 0.11 * i},
                        {"uncertainty_N", known ? json(0.02) : json(nullptr)},
                        {"scatter_N", known ? json(0.03) : json(nullptr)},
                        {"jnd", 0.1 / 0.07}});
    }
    json common = {{"kind", kind},
                   {"rmse_N", 0.062},
                   {"normalised_rmse", 0.062},
                   {"bias_N", 0.055},
                   {"rms_jnd", 1.43},
                   {"noticeable_fraction", 1.0},
                   {"within_uncertainty_fraction", known ? json(0.4) : json(nullptr)},
                   {"scatter_N", known ? json(0.03) : json(nullptr)},
                   {"worst", points.back()}};
    json summary = common;
    summary.update({{"curves", nodes.size()},
                    {"points", 10 * nodes.size()},
                    {"agreement_low_N", 0.0},
                    {"agreement_high_N", 0.11},
                    {"worst_vertex", nodes.front().vertex}});
    all["summaries"].push_back(summary);
    for (const ComparedNode& node : nodes) {
      json curve = common;
      curve.update({{"vertex", node.vertex},
                    {"rmse_N", 0.062 * node.error},
                    {"rms_jnd", 1.43 * node.error},
                    {"lateral_depth_m", known ? 0.0 : 0.003},
                    {"r2", 0.95},
                    {"uncertainty_N", known ? json(0.02) : json(nullptr)},
                    {"points", points}});
      all["curves"].push_back(curve);
    }
  }
  return all.dump();
}

bool is_fitted(const palpate::Library& library, std::int32_t v) {
  return library.responses[static_cast<std::size_t>(v)].status == palpate::ResponseStatus::Fitted;
}

/// What a few measured sites make: the stiffest node alone (the page faces it) with the largest
/// error, and the corners of a triangle apart from it.
std::vector<ComparedNode> sparse_nodes(const palpate::Library& library) {
  const auto place = [&](std::int32_t v) { return library.positions[static_cast<std::size_t>(v)]; };
  std::int32_t stiffest = library.triangles.front()[0];
  for (const auto& triangle : library.triangles) {
    for (const std::int32_t v : triangle) {
      if (is_fitted(library, v) && palpate::testing::hertz_factor(place(v)) >
                                       palpate::testing::hertz_factor(place(stiffest)))
        stiffest = v;
    }
  }
  for (const auto& triangle : library.triangles) {
    const bool apart = std::all_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
      const double away = palpate::norm(place(v) - place(stiffest));
      return is_fitted(library, v) && away > 0.015 && away < 0.03;
    });
    if (apart) return {{stiffest, 2}, {triangle[0], 0.9}, {triangle[1], 1.0}, {triangle[2], 1.1}};
  }
  throw std::logic_error("the sample body has no triangle beside its stiffest node");
}

std::string judgement_of(const std::string& library) {
  using nlohmann::json;
  const json row{{"what", "normal press, off node"},
                 {"part", "total"},
                 {"states", 40},
                 {"median", 0.021},
                 {"p95", 0.049},
                 {"worst", 0.123}};
  return json({{"kind", "palpate.fidelity"},
               {"floor_N", 0.02},
               {"friction", 0.3},
               {"points", {{{"at_node", false}}, {{"at_node", false}}, {{"at_node", true}}}},
               {"libraries", {{{"sha256", library}, {"rows", {row}}}}}})
      .dump();
}

palpate::ProvenanceStep sampling_step() {
  palpate::ProvenanceStep step;
  step.stage = "precompute";
  step.utc = "2026-01-01T00:00:00Z";
  step.facts = {{"sampling", "adaptive"},
                {"sampling_rounds", "4"},
                {"sites_computed", "87 of 1340"},
                {"hold_out_points", "40"},
                {"hold_out_error_along_press", "median 0.018, p95 0.046, worst 0.31"},
                {"hold_out_error_of_vector", "median 0.02, p95 0.05, worst 0.32"},
                {"sampling_ended", "the error at the hold-out points is within the tolerance"}};
  return step;
}

/// The body as it is, and as if repair had moved its upper half, by up to 2 mm.
void write_previews(palpate::Body body, const std::filesystem::path& folder) {
  palpate::report::write_preview(body, "", folder / "preview.html");
  palpate::ProvenanceStep step;
  step.stage = "mesh";
  step.inputs = {{"lump.off", std::string(64, 'a')}};
  body.provenance.steps = {step};
  palpate::report::DistanceMap moved{body.nodes, body.boundary, {}};
  for (const palpate::Vec3& x : body.nodes)
    moved.distance.push_back(0.002 * std::clamp(x[2] / 0.04, 0.0, 1.0));
  palpate::report::write_preview(body,
                                 palpate::report::repair_text(step.inputs[0].sha256, moved, moved),
                                 folder / "preview-repaired.html");
}

/// The side where x > 10 mm rests on springs.
void write_sprung(palpate::ReportInput input, palpate::Body body,
                  const std::filesystem::path& folder) {
  for (std::size_t f = 0; f < body.boundary.size(); ++f) {
    const auto aside = [&](std::int32_t n) {
      return body.nodes[static_cast<std::size_t>(n)][0] > 0.01;
    };
    if (std::all_of(body.boundary[f].begin(), body.boundary[f].end(), aside))
      body.foundation.push_back({static_cast<std::int32_t>(f), 1e6, 1e6});
  }
  input.body = &body;
  palpate::write_report(input, folder / "sprung.html");
}

/// With the skin of a deformation, with that of another library, and where the tissue relaxes.
void write_skins(const palpate::testing::Synthetic& all, const std::filesystem::path& folder) {
  using namespace palpate;
  testing::TouchedSkin skin(all.body, all.library);
  const report::SessionDigest session = report::digest(testing::rendered(all.recording, skin));
  ReportInput input{&all.body, &all.curves, &all.library, &session, "Lump", 356129};
  input.deformation = testing::deformation_bytes(all.body, all.library);
  write_report(input, folder / "skin.html");
  report::write_play_page(all.library, {&all.body, {}, {}, input.deformation},
                          folder / "play-skin.html");
  Library other = all.library;
  other.positions.front()[0] += 1e-6;
  input.deformation = testing::deformation_bytes(all.body, other);
  write_report(input, folder / "skin-other.html");
  const Library relaxing = test::relaxing(all.library, {0.05, 0.6}, true);
  input.library = &relaxing;
  input.deformation = testing::deformation_bytes(all.body, relaxing);
  write_report(input, folder / "skin-relaxing.html");
}

/// A library alone, its response surface with a skin of that surface, and a region inside.
void write_play_surface(const palpate::testing::Synthetic& all,
                        const std::filesystem::path& folder) {
  using namespace palpate;
  const std::string skin = testing::surface_deformation_bytes(all.body, all.library);
  const report::InnerSurface inside{"nodule",
                                    {{0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}, {0, 0, 0}},
                                    {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  report::write_play_page(all.library, {nullptr, all.body.response.triangles, {inside}, skin},
                          folder / "play-surface.html");
}

void write_pages_to_touch(const palpate::ReportInput& input, const palpate::testing::Synthetic& all,
                          const std::filesystem::path& folder) {
  palpate::report::write_play_page(all.library, {}, folder / "play.html");
  write_sprung(input, all.body, folder);
  const palpate::testing::Synthetic finer = palpate::testing::synthetic(3, 1);
  write_skins(finer, folder);
  write_play_surface(finer, folder);
}

/// Two tests of one law, as `palpate calibrate tests` writes them, with hostile names.
std::string calibration_text() {
  using nlohmann::json;
  const auto constant = [](const char* name, const char* unit, double value) {
    json profile = json::array();
    for (int i = -3; i <= 3; ++i) profile.push_back({value * (1 + 0.03 * i), i * i / 9.0});
    return json{{"name", name},
                {"unit", unit},
                {"value", value},
                {"standard_error", 0.05 * value},
                {"low", 0.9 * value},
                {"high", 1.1 * value},
                {"profile_low", 0.91 * value},
                {"profile_high", nullptr},
                {"profile", profile},
                {"at_bound", false}};
  };
  const auto test = [](const char* name, const char* mode, double rest) {
    json x = json::array(), measured = json::array(), fitted = json::array();
    for (int i = 0; i < 12; ++i) {
      x.push_back(rest + 0.05 * (i % 10));  // two deformations twice
      measured.push_back(2300.0 * i + (i % 2 == 0 ? 60 : -60));
      fitted.push_back(2300.0 * i);
    }
    return json{{"test", name},
                {"mode", mode},
                {"rms_Pa", 60},
                {"relative_rms", 0.004},
                {"r2", 0.99991},
                {"unstable_at", nullptr},
                {"deformation", x},
                {"measured_nominal_Pa", measured},
                {"fitted_nominal_Pa", fitted}};
  };
  const json account{
      {"artifact", "palpate.calibration"},
      {"schema", 1},
      {"name", "gel <b>bold</b>"},
      {"source", "a laboratory"},
      {"law", "mooney-rivlin"},
      {"confidence", 0.95},
      {"constants", json::array({constant("C10", "Pa", 4200), constant("C01", "Pa", -310)})},
      {"correlation", json::array({json::array({1, -0.912}), json::array({-0.912, 1})})},
      {"degrees_of_freedom", 22},
      {"effective_degrees_of_freedom", 14.2},
      {"residual_lag_one_correlation", 0.31},
      {"residual_durbin_watson", 1.4},
      {"intervals_widened_for_correlation", 1.7},
      {"warnings", json::array({"C01 <i>warned</i>"})},
      {"tests",
       json::array({test("pull.csv", "uniaxial", 1), test("twist.csv", "simple shear", 0)})}};
  return account.dump();
}

/// With a skin that deforms and a session on it.
void write_lump(const palpate::testing::Synthetic& all, const std::filesystem::path& file) {
  using namespace palpate;
  testing::TouchedSkin skin(all.body, all.library);
  const report::SessionDigest session = report::digest(testing::rendered(all.recording, skin));
  ReportInput input{&all.body, &all.curves, &all.library, &session, "Lump", 0};
  input.deformation = testing::deformation_bytes(all.body, all.library);
  write_report(input, file);
}

void write_samples(const std::filesystem::path& folder) {
  auto all = palpate::testing::synthetic(3, 2);
  const auto session = palpate::report::digest(all.recording);
  palpate::ReportInput input{&all.body, &all.curves,          &all.library,
                             &session,  "Lump with a nodule", 356129};
  palpate::write_report(input, folder / "full.html");

  write_previews(all.body, folder);
  palpate::report::write_calibration(calibration_text(), folder / "calibration.html");
  input.calibration = calibration_text();
  palpate::write_report(input, folder / "calibrated.html");
  input.calibration.clear();

  input.comparison = comparison_of({{all.curves.sites.front().vertex, 1.0}}, "<b>curves</b>.h5");
  palpate::write_report(input, folder / "compared.html");
  input.comparison = comparison_of(sparse_nodes(all.library), "curves.h5");
  palpate::write_report(input, folder / "sparse.html");
  input.comparison.clear();

  write_pages_to_touch(input, all, folder);

  const palpate::Provenance before = all.curves.provenance;
  all.curves.provenance.steps.push_back(sampling_step());
  input.library_sha256 = "cafe";
  input.fidelity = judgement_of(input.library_sha256);
  palpate::write_report(input, folder / "judged.html");
  input.fidelity = judgement_of("beef");
  palpate::write_report(input, folder / "judged-other.html");
  input.fidelity.clear();
  all.curves.provenance = before;

  // A rim too sharp for the slide to be bounded: on one triangle, and so for the body.
  auto& certificate = all.library.certificate;
  certificate.slip = certificate.triangles[0].slip = palpate::kInfinity;
  certificate.worst_triangle = 0;
  for (auto& device : certificate.devices) {
    if (!std::isnan(device.damping)) device.lowest_rate = palpate::kInfinity;
  }
  palpate::write_report(input, folder / "unbounded.html");

  // Everything that may be missing is missing, and every name is hostile.
  const std::string hostile =
      "</script><script>document.title='owned'</script><img src=x onerror=boom()> & \"'";
  all.body.name = all.library.name = all.curves.tool.shape = hostile;
  all.library.certificate = {};
  all.library.provenance.steps[0].stage = all.library.provenance.steps[0].facts[0].second = hostile;
  all.curves.provenance = all.body.provenance = {};
  for (auto& site : all.curves.sites) site.cpu_seconds = 0;
  input.title = hostile;
  input.session = nullptr;
  input.library_bytes = 0;
  palpate::write_report(input, folder / "bare.html");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    std::cerr << "usage: write_sample_report <folder> [<patches> <refinements>]\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  if (argc == 2) {
    write_samples(folder);
  } else {
    write_lump(palpate::testing::synthetic(std::stoi(argv[2]), std::stoi(argv[3])),
               folder / "lump.html");
  }
}
