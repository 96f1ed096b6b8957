// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/calibrate/account.hpp"
#include "app/calibrate/fit_file.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/pipeline/workspace.hpp"
#include "format/crash_safe_file.hpp"
#include "format/provenance.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Options {
  std::string fit_file, out;
};

Json inputs_of(const std::vector<fs::path>& files) {
  Json inputs = Json::object();
  for (const fs::path& file : files) inputs[file.filename().string()] = sha256_of_file(file);
  return inputs;
}

int calibrate_tests(const Options& options) {
  const FitFile file = read_fit_file(options.fit_file);
  const calibrate::HomogeneousFit fit = calibrate::fit_homogeneous(file.tests, file.settings);
  say("calibrate: {} on {} tests of {}", file.settings.law, file.tests.size(), file.name);
  say_calibration(fit.calibration, file.settings.confidence);
  say_homogeneous(fit);
  if (options.out.empty()) return kExitDone;
  std::vector<fs::path> files = file.files;
  files.insert(files.begin(), options.fit_file);
  Json account = {{"name", file.name},
                  {"source", file.source},
                  {"licence", file.licence},
                  {"creator", creator_text()},
                  {"input_sha256", inputs_of(files)}};
  account.update(homogeneous_account(fit, file.settings, file.tests));
  prepare_output(options.out);
  const fs::path target = fs::path(options.out) / "calibration.json";
  write_file_crash_safely(target, account.dump(2) + "\n");
  say("calibrate: {}", target.string());
  return kExitDone;
}

}  // namespace

void add_calibrate_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("calibrate", "Constants of a law from measurements, with intervals");
  command->require_subcommand(1);
  CLI::App* tests = command->add_subcommand(
      "tests", "From homogeneous tests: uniaxial, equibiaxial, pure shear, simple shear");
  tests->footer("Example: palpate calibrate tests data/measured/treloar-1944/ogden.toml");
  const auto options = std::make_shared<Options>();
  tests->add_option("FIT", options->fit_file, "Fit file (TOML), see docs/measured.md")->required();
  tests->add_option("--out", options->out, "Folder for calibration.json (default: print only)");
  tests->callback([options, &action] { action = [options] { return calibrate_tests(*options); }; });
}

}  // namespace palpate::app
