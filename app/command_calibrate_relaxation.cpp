// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/calibrate/account.hpp"
#include "app/calibrate/calibration_files.hpp"
#include "app/calibrate/relaxation_account.hpp"
#include "app/case/quantity.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/measured/import.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/provenance.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

struct RelaxationOptions {
  std::vector<std::string> files, times;
  std::string out, curve = "power", criterion = "BIC", exponent = "free";
  int terms = 0, most_terms = 3;
  double confidence = 0.95;
  bool no_profiles = false;
};

calibrate::RelaxationSettings settings_of(const RelaxationOptions& options) {
  calibrate::RelaxationSettings settings;
  settings.curve = options.curve == "power" ? calibrate::ElasticCurve::Power
                                            : calibrate::ElasticCurve::TwoPowers;
  settings.criterion =
      options.criterion == "BIC" ? calibrate::Criterion::Bic : calibrate::Criterion::Aicc;
  settings.fit_exponent = options.exponent == "free";
  if (!settings.fit_exponent) {
    char* end = nullptr;
    settings.exponent = std::strtod(options.exponent.c_str(), &end);
    if (end == options.exponent.c_str() || *end != '\0')
      refuse(
          "--exponent " + options.exponent, "it is no number",
          "give free, or a number: 1.5 for a sphere, 1 for a flat punch or plates, 2 for a cone");
  }
  settings.terms = options.terms;
  settings.most_terms = std::max(options.most_terms, options.terms);
  for (const std::string& text : options.times) {
    const ParsedQuantity time = parse_quantity(text, Dimension::Time);
    if (time.fault != QuantityFault::None)
      refuse("--times " + text, "it is no time with its unit", "write for example \"200 ms\"");
    settings.times.push_back(time.value);
  }
  settings.confidence = options.confidence;
  settings.profiles = !options.no_profiles;
  return settings;
}

/// Records of histories.json, or of the [[history]] entries of a sidecar.
Histories histories_of(const std::string& file) {
  Histories histories = std::filesystem::path(file).extension() == ".toml" ? import_histories(file)
                                                                           : read_histories(file);
  if (histories.records.empty())
    refuse(file, "it has no record over time", "list the records as [[history]]");
  return histories;
}

struct Input {
  std::vector<calibrate::RelaxationRecord> records;
  Histories first;  ///< names, licence and tool
};

Input input_of(const RelaxationOptions& options) {
  Input input;
  for (const std::string& file : options.files) {
    const Histories histories = histories_of(file);
    if (input.records.empty()) input.first = histories;
    const ToolDescription &a = histories.tool, &b = input.first.tool;
    if (a.shape != b.shape || a.radius != b.radius)
      refuse(file, "its tool is another one than that of " + options.files.front(),
             "fit records of one tool together");
    for (const SiteHistory& site : histories.records)
      input.records.push_back(calibrate::relaxation_record(site.history));
  }
  return input;
}

int calibrate_relaxation(const RelaxationOptions& options) {
  const calibrate::RelaxationSettings settings = settings_of(options);
  const Input input = input_of(options);
  const double radius = input.first.tool.shape == "sphere" ? input.first.tool.radius : 0;
  const calibrate::RelaxationFit fit = calibrate::fit_relaxation(input.records, settings);
  say("calibrate: relaxation of {} from {}", input.first.specimen,
      count_text(input.records.size(), "record"));
  say_calibration(fit.calibration, settings.confidence);
  say_relaxation(fit, input.records, radius);
  if (options.out.empty()) return kExitDone;
  nlohmann::ordered_json inputs = nlohmann::ordered_json::object();
  for (const std::string& file : options.files)
    inputs[std::filesystem::path(file).filename().string()] = sha256_of_file(file);
  nlohmann::ordered_json account = {{"artifact", "palpate.calibration"},
                                    {"schema", 1},
                                    {"name", input.first.name},
                                    {"source", input.first.source},
                                    {"licence", input.first.licence},
                                    {"creator", creator_text()},
                                    {"input_sha256", inputs}};
  account.update(relaxation_account(fit, settings, input.records, radius));
  say("calibrate: {}", write_calibration_files(account, options.out));
  return kExitDone;
}

}  // namespace

void add_calibrate_relaxation(CLI::App& command, Action& action) {
  CLI::App* part = command.add_subcommand(
      "relaxation", "Identifies a Prony series from records over time: relaxation, creep, cycles");
  part->footer("Example: palpate calibrate relaxation out/held/histories.json --out out/held");
  const auto options = std::make_shared<RelaxationOptions>();
  part->add_option("FILE", options->files,
                   "histories.json of `palpate import`, or a sidecar with [[history]] records")
      ->required();
  part->add_option("--terms", options->terms, "Number of terms (default: chosen by the criterion)")
      ->check(CLI::Range(1, 4));
  part->add_option("--most-terms", options->most_terms, "Largest number of terms that is tried")
      ->capture_default_str()
      ->check(CLI::Range(1, 4));
  part->add_option("--times", options->times,
                   "Relaxation times that are given, ascending, with units (default: free)");
  part->add_option("--criterion", options->criterion, "By which the number of terms is chosen")
      ->capture_default_str()
      ->check(CLI::IsMember({"BIC", "AICc"}));
  part->add_option("--curve", options->curve, "Elastic force over travel")
      ->capture_default_str()
      ->check(CLI::IsMember({"power", "two powers"}));
  part->add_option("--exponent", options->exponent,
                   "Exponent of the elastic force: free, or its value")
      ->capture_default_str();
  part->add_option("--confidence", options->confidence, "Confidence level of the intervals")
      ->capture_default_str()
      ->check(CLI::Range(0.5, 0.9999));
  part->add_flag("--no-profiles", options->no_profiles,
                 "Without the intervals by profile likelihoods, which take most of the time");
  part->add_option(
      "--out", options->out,
      "Folder for calibration.json, correlations.csv and calibration.html (default: print only)");
  part->callback(
      [options, &action] { action = [options] { return calibrate_relaxation(*options); }; });
}

}  // namespace palpate::app
