// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/calibrate/account.hpp"
#include "app/calibrate/calibration_files.hpp"
#include "app/calibrate/slab_fit.hpp"
#include "app/case/material.hpp"
#include "app/case/quantity.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/json_number.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/provenance.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The range of thicknesses where none is given, over the deepest press.
constexpr double kThinnest = 2.5, kThickest = 20;

struct SlabOptions {
  std::string curves, law = "demiray-fung", out;
  std::vector<std::string> thickness;
  std::vector<double> stiffening;
  std::vector<int> points{5, 6};
  double poisson = 0.49, confidence = 0.95;
  int depths = 6, threads = 0;
};

double length_of(const std::string& text) {
  const ParsedQuantity length = parse_quantity(text, Dimension::Length);
  if (length.fault == QuantityFault::None) return length.value;
  refuse("--thickness " + text, "it is no length with its unit", "write for example \"12 mm\"");
}

SlabTableSettings table_settings(const SlabOptions& options, const Curves& measured) {
  if (measured.tool.shape != "sphere")
    refuse(options.curves, "they were made with a " + measured.tool.shape,
           "slabs are calibrated from presses of a sphere");
  SlabTableSettings settings;
  settings.law = stiffening_law(options.law);
  if (!options.stiffening.empty()) {
    settings.law.low = options.stiffening[0];
    settings.law.high = options.stiffening[1];
  }
  settings.poisson = options.poisson;
  settings.tool.radius = measured.tool.radius;
  settings.friction = measured.tool.friction == "no-slip" ? fem::ToolFriction::NoSlip
                                                          : fem::ToolFriction::Frictionless;
  settings.depths = compared_depths(measured, options.depths);
  settings.thickness_low = kThinnest * settings.depths.back();
  settings.thickness_high = kThickest * settings.depths.back();
  if (!options.thickness.empty()) {
    settings.thickness_low = length_of(options.thickness[0]);
    settings.thickness_high = length_of(options.thickness[1]);
  }
  settings.stiffenings = options.points[0];
  settings.thicknesses = options.points[1];
  settings.threads = options.threads > 0 ? options.threads : processors();
  settings.advanced = [](int done, int all) {
    if (done == all || done % 10 == 0) say("  {} of {} slabs are pressed", done, all);
  };
  return settings;
}

/// "between 8.1 mm and 11 mm", "at least 8.1 mm", or what it is when nothing is known.
std::string interval_text(const Identified& what, const std::function<std::string(double)>& text) {
  if (what.is_nothing())
    return "not identified: all of " + text(what.low) + " to " + text(what.high) + " fits";
  if (what.no_high) return "at least " + text(what.low) + "; an upper end is not identified";
  if (what.no_low) return "at most " + text(what.high) + "; a lower end is not identified";
  return text(what.value) + ", between " + text(what.low) + " and " + text(what.high);
}

void say_slab(const SlabFit& slab, const SlabTable& table, double confidence) {
  const SlabTableSettings& s = table.settings();
  const auto number = [](double v) { return number_text(v); };
  answer("calibrate: {} as one slab of {}, RMS residual {} ({} of the largest force)",
         count_text(slab.fit.paths.size(), "site"), s.law.name, force_text(slab.fit.rms),
         percent_text(slab.fit.relative_rms));
  answer("  thickness, {:.4g} %: {}", 100 * confidence, interval_text(slab.thickness, length_text));
  answer("  {}, {:.4g} %: {}", s.law.stiffening, 100 * confidence,
         interval_text(slab.stiffening, number));
  answer("  shear modulus at rest: median {} Pa, from {} Pa to {} Pa over the sites",
         number_text(slab.median_modulus), number_text(slab.least_modulus),
         number_text(slab.largest_modulus));
  answer(
      "  a modulus is correlated with the inverse thickness by {} and with {} by {}, in the median",
      number_text(slab.modulus_thickness), s.law.stiffening, number_text(slab.modulus_stiffening));
  answer("  the table, from {} to {} and {} from {} to {}, is off by {} between its points",
         length_text(s.thickness_low), length_text(s.thickness_high), s.law.stiffening,
         number_text(s.law.low), number_text(s.law.high), percent_text(table.error()));
  for (const std::string& warning : slab.fit.calibration.warnings) warn(warning);
}

Json identified_account(const Identified& what) {
  const char* said = what.is_nothing() ? "not identified"
                     : what.no_high    ? "lower bound"
                     : what.no_low     ? "upper bound"
                                       : "interval";
  return {{"identified", said},
          {"value", what.value},
          {"low", what.no_low ? Json(nullptr) : Json(what.low)},
          {"high", what.no_high ? Json(nullptr) : Json(what.high)}};
}

Json slab_account(const SlabFit& slab, const SlabTable& table, double confidence) {
  const SlabTableSettings& s = table.settings();
  Json account = press_account(slab.fit, confidence);
  account["slab"] = {{"law", s.law.name},
                     {"poisson", s.poisson},
                     {"thickness_m", identified_account(slab.thickness)},
                     {"stiffening", identified_account(slab.stiffening)},
                     {"stiffening_name", s.law.stiffening},
                     {"median_shear_modulus_Pa", slab.median_modulus},
                     {"modulus_thickness_correlation", json_number(slab.modulus_thickness)},
                     {"modulus_stiffening_correlation", json_number(slab.modulus_stiffening)},
                     {"thickness_range_m", {s.thickness_low, s.thickness_high}},
                     {"stiffening_range", {s.law.low, s.law.high}},
                     {"table_error", table.error()},
                     {"case_material", material_keys(s.law.at(slab.median_modulus,
                                                              slab.stiffening.value, s.poisson))}};
  return account;
}

int calibrate_slab(const SlabOptions& options) {
  const Curves measured = read_curves(options.curves);
  const SlabTable table(table_settings(options, measured));
  PressFitSettings settings;
  settings.confidence = options.confidence;
  const SlabFit slab = fit_slab(measured, table, settings);
  say_slab(slab, table, options.confidence);
  if (options.out.empty()) return kExitDone;
  Json account = {
      {"artifact", "palpate.calibration"},
      {"schema", 1},
      {"name", "slab"},
      {"creator", creator_text()},
      {"input_sha256",
       {{fs::path(options.curves).filename().string(), sha256_of_file(options.curves)}}}};
  account.update(slab_account(slab, table, options.confidence));
  const std::string files = write_calibration_files(account, options.out);
  Curves fitted = fitted_curves(measured, slab.fit);
  fitted.provenance.steps.push_back(make_provenance_step(
      "slab", "", {options.curves}, {{"origin", "slab fitted to measured curves"}}));
  write_curves(fs::path(options.out) / "curves.h5", fitted);
  say("calibrate: {}, curves.h5", files);
  return kExitDone;
}

}  // namespace

void add_calibrate_slab(CLI::App& calibrate, Action& action) {
  CLI::App* part = calibrate.add_subcommand(
      "slab",
      "Identifies stiffening, thickness and a modulus for each site, of presses of an organ as a "
      "slab on a rigid base");
  part->footer("Example: palpate calibrate slab out/liver-patch/curves.h5 --out out/liver-slab");
  const auto options = std::make_shared<SlabOptions>();
  part->add_option("CURVES", options->curves, "curves.h5 of measured presses by a sphere")
      ->required();
  part->add_option("--law", options->law,
                   "Law: demiray-fung, ogden-1, veronda-westmann, or yeoh without its cubic term")
      ->capture_default_str();
  part->add_option("--stiffening", options->stiffening,
                   "Range of its number: b, alpha_1, C2, or C20/C10")
      ->expected(2);
  part->add_option(
          "--thickness", options->thickness,
          "Range of the thickness, as \"8 mm\" \"60 mm\"; default: 2.5 to 20 times the depth")
      ->expected(2);
  part->add_option("--points", options->points,
                   "Slabs that are pressed along each range, of stiffening and of thickness")
      ->capture_default_str()
      ->expected(2)
      ->check(CLI::Range(2, 20));
  part->add_option("--poisson", options->poisson, "Poisson's ratio, which is not fitted")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 0.499));
  part->add_option("--depths", options->depths, "Number of depths of each curve that are compared")
      ->capture_default_str()
      ->check(CLI::Range(2, 200));
  part->add_option("--confidence", options->confidence, "Confidence level of the intervals")
      ->capture_default_str()
      ->check(CLI::Range(0.5, 0.9999));
  part->add_option("--threads", options->threads,
                   "Slabs that are pressed at once (default: one for each processor)")
      ->check(CLI::Range(1, 4096));
  part->add_option(
      "--out", options->out,
      "Folder of calibration.json, correlations.csv, calibration.html and curves.h5, the "
      "fitted forces");
  part->callback([options, &action] { action = [options] { return calibrate_slab(*options); }; });
}

}  // namespace palpate::app
