// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/measured/histories.hpp"
#include "app/pipeline/workspace.hpp"
#include "fitting/measurement/compare/rescale.hpp"
#include "format/number_text.hpp"
#include "format/provenance.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

struct RescaleOptions {
  std::string simulated, measured, out;
};

/// With records over time the part that relaxes during a press does not count as softness.
compare::Rescaling rescaling(const Curves& simulated, const fs::path& measured) {
  if (measured.extension() != ".json")
    return compare::rescale(simulated, read_curves(measured), {});
  const Histories histories = histories_with_sites(measured);
  require_same_tool(histories, simulated.tool.shape, simulated.tool.radius, measured.string());
  return compare::rescale_over_time(simulated, histories.records);
}

int rescale_curves(const RescaleOptions& options) {
  const Curves simulated = read_curves(options.simulated);
  compare::Rescaling result = rescaling(simulated, options.measured);
  say("rescale: measured = {:.4f} +- {:.4f} of simulated, from {}", result.factor,
      result.uncertainty, count_text(result.sites.size(), "site"));
  for (const compare::SiteScale& site : result.sites) {
    say("  site {}: {:.4f} +- {:.4f}, residual {:.2g} % of its largest force", site.vertex,
        site.factor, site.uncertainty, 100 * site.misfit);
  }
  result.curves.provenance.steps.push_back(
      make_provenance_step("rescale", "", {options.simulated, options.measured},
                           {{"origin", "simulated shape, measured scale"},
                            {"factor", fmt::format("{}", result.factor)},
                            {"standard_uncertainty", fmt::format("{}", result.uncertainty)},
                            {"measured_sites", std::to_string(result.sites.size())}}));
  prepare_output(options.out);
  const fs::path target = fs::path(options.out) / "curves.h5";
  write_curves(target, result.curves);
  say("rescale: {}", target.string());
  return kExitDone;
}

}  // namespace

void add_rescale_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("rescale", "Scales simulated curves to measured forces -> curves.h5");
  command->footer(
      "Example: palpate rescale out/pad/curves.h5 out/pad-measured/curves.h5 --out out/scaled");
  const auto options = std::make_shared<RescaleOptions>();
  command->add_option("SIMULATED", options->simulated, "curves.h5 of `palpate precompute`")
      ->required();
  command
      ->add_option("MEASURED", options->measured, "curves.h5 or histories.json of `palpate import`")
      ->required();
  command->add_option("--out", options->out, "Folder of the new curves.h5")->required();
  command->callback(
      [options, &action] { action = [options] { return rescale_curves(*options); }; });
}

}  // namespace palpate::app
