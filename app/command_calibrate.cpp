// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/calibrate/account.hpp"
#include "app/calibrate/calibration_files.hpp"
#include "app/calibrate/clamped_fit.hpp"
#include "app/calibrate/fit_file.hpp"
#include "app/calibrate/inverse.hpp"
#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/workspace.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/provenance.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct CalibrateOptions {
  std::string fit_file, out;
};

Json inputs_of(const std::vector<fs::path>& files) {
  Json inputs = Json::object();
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    inputs[inputs.contains(name) ? file.string() : name] = sha256_of_file(file);
  }
  return inputs;
}

/// What the clamps of a specimen do to its stress; empty where it has none.
std::string clamp_text(bool is_clamped, double largest_effect) {
  if (!is_clamped) return {};
  return ", between glued clamps: by finite elements up to " + percent_text(largest_effect) +
         " off the formula";
}

int calibrate_tests(const CalibrateOptions& options) {
  const FitFile file = read_fit_file(options.fit_file);
  const ClampedFit clamped = fit_clamped(file.tests, file.specimens, file.settings);
  const calibrate::HomogeneousFit& fit = clamped.fit;
  say("calibrate: {} on {} of {}", file.settings.law, count_text(file.tests.size(), "test"),
      file.name);
  for (std::size_t i = 0; i < file.tests.size(); ++i)
    say("  {}: {}{}", file.tests[i].name, file.statements[i],
        clamp_text(file.specimens[i].has_value(), clamped.largest_effect[i]));
  say_calibration(fit.calibration, file.settings.confidence);
  say_homogeneous(fit);
  if (options.out.empty()) return kExitDone;
  std::vector<fs::path> files = file.files;
  files.insert(files.begin(), options.fit_file);
  Json account = {{"artifact", "palpate.calibration"},
                  {"schema", 1},
                  {"name", file.name},
                  {"source", file.source},
                  {"licence", file.licence},
                  {"conversions", file.statements},
                  {"largest_effect_of_clamps", clamped.largest_effect},
                  {"creator", creator_text()},
                  {"input_sha256", inputs_of(files)}};
  account.update(homogeneous_account(fit, file.settings, file.tests));
  say("calibrate: {}", write_calibration_files(account, options.out));
  return kExitDone;
}

/// Largest factor between a constant and its start value, and the largest Poisson's ratio.
constexpr double kConstantFactor = 100;
constexpr double kLargestPoisson = 0.4995;

struct BodyOptions {
  std::shared_ptr<CaseOptions> common;
  std::vector<std::string> measured;
  std::vector<std::string> young, poisson, constant;
  int depths = 6;
  bool drags = false;
  double confidence = 0.95;
  std::string profiles = "doubtful";
};

/// The constant with its bounds: a factor to either side of its start, within the range of the law.
SoughtConstant sought_constant(const fem::CampaignSettings& campaign, const std::string& region,
                               const std::string& name) {
  const auto material =
      std::find_if(campaign.materials.begin(), campaign.materials.end(),
                   [&](const fem::RegionMaterial& m) { return m.region == region; });
  if (material == campaign.materials.end()) {
    throw Error(ErrorKind::Configuration, "region '" + region + "'", "the case has no such region",
                "name a region of its [[material]] tables");
  }
  const fem::LawConstant& constant = fem::law_constant(material->law.law, name);
  if (name == "poisson") return {{region, name}, 0, kLargestPoisson};
  const double start = material->law.at(name), far = kConstantFactor * std::abs(start);
  const bool may_change_sign = constant.is_stress && constant.low < 0;
  const double near = may_change_sign ? -far : std::abs(start) / kConstantFactor;
  const auto [low, high] =
      start < 0 && !may_change_sign ? std::pair(-far, -near) : std::pair(near, far);
  return {{region, name}, std::max(low, constant.low), std::min(high, constant.high)};
}

InverseSettings inverse_settings(const BodyOptions& options, const Workspace& space) {
  InverseSettings settings;
  for (const MaterialSection& material : space.c.materials)
    if (!material.relaxation.empty() && material.moduli == fem::Moduli::LongTerm)
      refuse("material of region '" + material.region + "'",
             "a campaign has the instantaneous constants, and the case has those of the long term",
             "calibrate a case with moduli = \"instantaneous\", or without relaxation");
  settings.campaign = campaign_settings(space);
  settings.depths = options.depths;
  settings.drags = options.drags;
  settings.confidence = options.confidence;
  settings.profiles = options.profiles == "all"    ? Profiles::All
                      : options.profiles == "none" ? Profiles::None
                                                   : Profiles::Doubtful;
  settings.log = [](const std::string& line) { say("  {}", line); };
  for (const std::string& region : options.young) {
    settings.sought.push_back(sought_constant(settings.campaign, region, "young"));
  }
  for (const std::string& region : options.poisson) {
    settings.sought.push_back(sought_constant(settings.campaign, region, "poisson"));
  }
  for (const std::string& text : options.constant) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos) {
      throw Error(ErrorKind::Configuration, "--constant " + text, "it does not name a constant",
                  "write REGION:NAME, for example liver:C10");
    }
    settings.sought.push_back(
        sought_constant(settings.campaign, text.substr(0, colon), text.substr(colon + 1)));
  }
  return settings;
}

/// Curves of the body, a file for each tool.
std::vector<Curves> measured_on(const Workspace& space, const std::vector<std::string>& files) {
  std::vector<Curves> measured;
  for (const std::string& file : files) {
    const Curves& curves = measured.emplace_back(read_curves(file));
    if (!curves.body_sha256.empty() && curves.body_sha256 != sha256_of_file(space.body()))
      throw Error(ErrorKind::Configuration, file,
                  "it belongs to another body than " + space.body().string(),
                  "import the measurement again with --body " + space.body().string());
    if (files.size() > 1)
      say("  curves {}: {} under a {} of {} radius, {}", measured.size(),
          count_text(curves.sites.size(), "site"), curves.tool.shape,
          length_text(curves.tool.radius), file);
  }
  return measured;
}

int calibrate_body(const BodyOptions& options) {
  const Workspace space = open_workspace(*options.common);
  const Body body = read_body(space.body());
  const std::vector<Curves> measured = measured_on(space, options.measured);
  const PressFit fit = calibrate_inverse(body, measured, inverse_settings(options, space));
  const auto drags = std::count_if(fit.paths.begin(), fit.paths.end(),
                                   [](const FittedPath& p) { return p.kind == PathKind::Lateral; });
  const auto presses = static_cast<std::ptrdiff_t>(fit.paths.size()) - drags;
  say("calibrate: {}, {}, RMS residual {} ({} of the largest force), {}",
      count_text(presses, "site"), count_text(drags, "drag"), force_text(fit.rms),
      percent_text(fit.relative_rms), count_text(fit.evaluations, "evaluation"));
  if (fit.profile_evaluations > 0)
    say("calibrate: {} more evaluations for the profiles", fit.profile_evaluations);
  say_calibration(fit.calibration, options.confidence);
  std::vector<fs::path> inputs(options.measured.begin(), options.measured.end());
  inputs.insert(inputs.begin(), space.body());
  Json account = {{"artifact", "palpate.calibration"},
                  {"schema", 1},
                  {"name", space.c.name},
                  {"creator", creator_text()},
                  {"input_sha256", inputs_of(inputs)},
                  {"resolved_case", resolved_toml(space.c)}};
  account.update(press_account(fit, options.confidence));
  say("calibrate: {}", write_calibration_files(account, space.out, false));
  return kExitDone;
}

void add_body_part(CLI::App& command, Action& action) {
  CLI::App* part = command.add_subcommand(
      "body",
      "Identifies constants from indentation curves of a body, by the finite element model");
  part->footer(
      "Example: palpate calibrate body data/cases/pad.toml --measured out/pad-measured/curves.h5 "
      "--young gel --out out/pad");
  const auto options = std::make_shared<BodyOptions>();
  options->common = add_case_options(*part, ThreadsOption::Present);
  part->add_option(
          "--measured", options->measured,
          "curves.h5 of `palpate import`; several, of several tools, are calibrated together")
      ->required();
  part->add_option("--young", options->young,
                   "Region whose Young's modulus is identified; may be repeated");
  part->add_option("--poisson", options->poisson,
                   "Region whose Poisson's ratio is identified; may be repeated");
  part->add_option(
      "--constant", options->constant,
      "Any constant of the law of a region, as REGION:NAME (liver:C10); may be repeated");
  part->add_option("--depths", options->depths, "Number of depths of each curve that are compared")
      ->capture_default_str()
      ->check(CLI::Range(2, 200));
  part->add_flag("--drags", options->drags,
                 "Also compare measured drags; needs a mesh that resolves the contact");
  part->add_option("--confidence", options->confidence, "Confidence level of the intervals")
      ->capture_default_str()
      ->check(CLI::Range(0.5, 0.9999));
  part->add_option(
          "--profiles", options->profiles,
          "Profile-likelihood intervals: of constants whose linearised interval is doubtful, "
          "of all, of none. Each end takes 1 to 20 evaluations of the model")
      ->capture_default_str()
      ->check(CLI::IsMember({"doubtful", "all", "none"}));
  part->callback([options, &action] { action = [options] { return calibrate_body(*options); }; });
}

}  // namespace

void add_calibrate_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "calibrate", "Identifies constants of a law from measurements, with confidence intervals");
  command->footer("Example: palpate calibrate tests data/measured/treloar-1944/ogden.toml");
  command->require_subcommand(1);
  CLI::App* tests =
      command->add_subcommand("tests",
                              "Identifies constants from homogeneous tests: "
                              "uniaxial, equibiaxial, pure shear, simple shear, confined "
                              "compression");
  tests->footer("Example: palpate calibrate tests data/measured/treloar-1944/ogden.toml");
  const auto options = std::make_shared<CalibrateOptions>();
  tests->add_option("FIT", options->fit_file, "Fit file (TOML), see docs/measured.md")->required();
  tests->add_option(
      "--out", options->out,
      "Folder for calibration.json, correlations.csv and calibration.html (default: print only)");
  add_body_part(*command, action);
  add_calibrate_relaxation(*command, action);
  add_calibrate_slab(*command, action);
  tests->callback([options, &action] { action = [options] { return calibrate_tests(*options); }; });
}

}  // namespace palpate::app
