// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/measured/import.hpp"
#include "app/measured/patch_body.hpp"
#include "app/measured/request.hpp"
#include "app/pipeline/workspace.hpp"
#include "format/body.hpp"
#include "format/crash_safe_file.hpp"
#include "format/number_text.hpp"
#include "format/numbers.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

struct ImportOptions {
  std::vector<std::string> inputs;
  std::string body, out;
  bool allow_refused = false;
};

/// A value that is unknown stands as null.
double number_of(const nlohmann::ordered_json& value) {
  return value.is_null() ? kUnknown : value.get<double>();
}

/// A record, or the site of a batch.
std::string name_of(const nlohmann::ordered_json& record) {
  const auto file = record["file"].get<std::string>();
  return record.contains("site") ? file + ", " + record["site"].get<std::string>() : file;
}

/// Each record that was taken or refused, where there are several.
void say_records(const Import& result) {
  const auto& records = result.account["records"];
  if (records.size() + result.account["refused"].size() < 2) return;
  for (const auto& record : records)
    say("  imported {}: {} {}", name_of(record), record.contains("site") ? "vertex" : "site",
        record["vertex"].get<int>());
  for (const auto& refused : result.account["refused"])
    say("  refused {}: {}", name_of(refused), refused["reason"].get<std::string>());
}

/// Which press of a record that has several was taken.
void say_cycle(const nlohmann::ordered_json& record) {
  if (record["cycles"].get<int>() < 2) return;
  say("  {}: cycle {} of {}, {} deep; `cycle` chooses another", record["file"].get<std::string>(),
      record["cycle"].get<int>(), record["cycles"].get<int>(),
      length_text(record["deepest_m"].get<double>()));
}

void say_history(const SiteHistory& site) {
  const measured::History& h = site.history;
  const bool force = h.control == measured::Control::Force;
  say("  {}: the {} is held, {}, contact at {} +- {}", h.name, force ? "force" : "travel",
      count_text(h.time.size(), "sample"), length_text(h.contact.displacement),
      length_text(h.contact.uncertainty));
  for (const measured::Phase& phase : h.phases)
    say("    {} from {:.5g} s to {:.5g} s: to {}, {}", phase_name(phase.kind), h.time[phase.begin],
        h.time[phase.end - 1], length_text(h.travel[phase.end - 1]),
        force_text(h.force[phase.end - 1]));
}

void write_histories(const Histories& histories, const fs::path& sidecar, const fs::path& out) {
  nlohmann::ordered_json json = histories_json(histories);
  json["input_sha256"] = {{sidecar.filename().string(), sha256_of_file(sidecar)}};
  write_file_crash_safely(out / "histories.json", json.dump() + "\n");
  for (const SiteHistory& site : histories.records) say_history(site);
  say("import: {} over time -> {}", count_text(histories.records.size(), "record"),
      (out / "histories.json").string());
}

/// The surface of the records alone. @return its file.
fs::path write_patch(const fs::path& sidecar, const fs::path& out, const std::string& tool) {
  PatchBody patch = patch_body(sidecar, tool);
  for (const std::string& warning : patch.warnings) warn(warning);
  patch.body.provenance.steps.push_back(
      make_provenance_step("mesh", "", measured_files(sidecar, tool), {{"origin", "measured"}}));
  fs::path file = out / "body.h5";
  prepare_output(out);
  write_body(file, patch.body);
  say("import: surface of {}, {} apart -> {}", count_text(patch.body.nodes.size(), "site"),
      length_text(patch.spacing), file.string());
  return file;
}

/// The records with the body of the options, or with the surface that they make. A surface without
/// curves is of no use: none is left where the records are refused.
Import import_on_body(const ImportOptions& options, const ImportRequest& request,
                      const std::string& tool, const fs::path& out) {
  if (!options.body.empty() || !makes_body(read_sidecar(request.sidecar, tool)))
    return import_measurement(request.sidecar, options.body, request.records, tool);
  const bool is_new = !fs::exists(out / "body.h5");
  const fs::path body = write_patch(request.sidecar, out, tool);
  try {
    return import_measurement(request.sidecar, body, request.records, tool);
  } catch (...) {
    std::error_code ignored;
    if (is_new) fs::remove(body, ignored);
    throw;
  }
}

/// The records of one tool. @return how many were refused.
int import_tool(const ImportOptions& options, const ImportRequest& request, const std::string& tool,
                const fs::path& out) {
  const Import result = import_on_body(options, request, tool, out);
  prepare_output(out);
  if (!result.curves.sites.empty()) write_curves(out / "curves.h5", result.curves);
  if (!result.histories.records.empty()) write_histories(result.histories, request.sidecar, out);
  write_file_crash_safely(out / "import.json", result.account.dump(2) + "\n");
  say_records(result);
  for (const auto& record : result.account["records"]) say_cycle(record);
  if (result.account.contains("conversion"))
    say("  {}", result.account["conversion"].get<std::string>());
  for (const auto& site : result.account["sites"]) {
    say("  site {}: {} to {}, {} +- {}, contact point +- {}", site["vertex"].get<int>(),
        count_text(site["repeats"].get<std::size_t>(), "repeat"),
        length_text(number_of(site["depth_m"])), force_text(number_of(site["force_N"])),
        force_text(number_of(site["force_uncertainty_N"])),
        length_text(number_of(site["contact_uncertainty_m"])));
    for (const auto& drag : site["lateral_paths"]) {
      if (drag["repeats"] == 0) continue;  // derived from the normal path, not measured
      say("    drag at {}: {} to {}, {} +- {}", length_text(number_of(drag["lateral_depth_m"])),
          count_text(drag["repeats"].get<std::size_t>(), "repeat"),
          length_text(number_of(drag["travel_m"])), force_text(number_of(drag["force_N"])),
          force_text(number_of(drag["force_uncertainty_N"])));
    }
  }
  for (const auto& warning : result.account["warnings"]) {
    warn(warning.get<std::string>());
  }
  if (!result.curves.sites.empty())
    say("import: {} at {} -> {} (account in import.json)",
        count_text(result.account["records"].size(), "record"),
        count_text(result.curves.sites.size(), "site"), (out / "curves.h5").string());
  if (result.refused > 0)
    say("import: {} refused, see above; the curves are those of the others", result.refused);
  return result.refused;
}

/// The request for the records of one tool; those that no tool has go to the first, which refuses
/// them.
ImportRequest part_of(const ImportRequest& request, const std::vector<std::string>& tools,
                      std::size_t tool) {
  if (tools.size() == 1 || request.records.empty()) return request;
  ImportRequest part{request.sidecar, {}};
  for (const fs::path& record : request.records) {
    std::size_t of = 0;
    for (std::size_t i = 0; i < tools.size(); ++i)
      for (const fs::path& file : measured_files(request.sidecar, tools[i]))
        if (fs::weakly_canonical(file) == fs::weakly_canonical(record)) of = i;
    if (of == tool) part.records.push_back(record);
  }
  return part;
}

/// Each of several tools has a folder of its name.
int import_records(const ImportOptions& options) {
  const ImportRequest request = import_request(options.inputs);
  const std::vector<std::string> tools = tools_of_sidecar(request.sidecar);
  int refused = 0;
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const ImportRequest part = part_of(request, tools, i);
    if (part.records.empty() && !request.records.empty()) continue;
    if (tools.size() > 1) say("import: tool '{}'", tools[i]);
    refused += import_tool(options, part, tools[i], fs::path(options.out) / tools[i]);
  }
  return refused == 0 || options.allow_refused ? kExitDone : kExitSomeSitesFailed;
}

}  // namespace

void add_import_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "import",
      "Records of a testing machine or robot -> curves.h5, and over time -> histories.json");
  command->footer(
      "Example: palpate import data/measured/pad/presses.toml --body out/pad/body.h5 "
      "--out out/pad-measured");
  const auto options = std::make_shared<ImportOptions>();
  command
      ->add_option("SIDECAR", options->inputs,
                   "Sidecar (TOML), see docs/measured.md; or records of it, or patterns of them "
                   "('data/*.csv'), where it is the only TOML file beside them or stands in front")
      ->required();
  command->add_option(
      "--body", options->body,
      "body.h5 that contains the sites (default with [[batch]] alone: the surface of "
      "their contact points, written to the folder)");
  command->add_option("--out", options->out, "Folder of the artifacts")->required();
  command->add_flag("--allow-refused", options->allow_refused,
                    "Exit with 0 although records were refused, as long as one was imported");
  command->callback(
      [options, &action] { action = [options] { return import_records(*options); }; });
}

}  // namespace palpate::app
