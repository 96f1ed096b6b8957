// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/compare/fidelity_run.hpp"
#include "app/compare/history_run.hpp"
#include "app/compare/leave_out.hpp"
#include "app/compare/tables.hpp"
#include "app/console.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "app/pipeline/stages.hpp"
#include "app/pipeline/workspace.hpp"
#include "format/artifact.hpp"
#include "format/body.hpp"
#include "format/crash_safe_file.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  std::string reference, model, reference_body, model_body, out;
  compare::CompareSettings settings;
  double jnd_floor_mn = kUnknown, site_tolerance_mm = kUnknown;  ///< NaN: by the reference
  std::vector<double> depths_mm;
  CaseOptions left_out;  ///< with a case: its sites are predicted from each other
  CaseOptions fem;       ///< with a case: its library is compared with direct solutions
  FidelityOptions fidelity;
  double floor_mn = 0;
  std::vector<std::string> libraries;
  std::string histories;  ///< with a case: records over time instead of hold-out points
};

void add_positions(compare::ComparedSet& set, const fs::path& file) {
  const Body body = read_body(file);
  if (!set.body_sha256.empty() && set.body_sha256 != sha256_of_file(file)) {
    throw Error(ErrorKind::Configuration, file.string(),
                "it is not the body of " + set.name + " (the digests differ)",
                "give the body.h5 that the curves were made with");
  }
  for (compare::ComparedSite& site : set.sites) {
    if (static_cast<std::size_t>(site.vertex) >= body.response.node.size()) {
      throw Error(ErrorKind::Configuration, file.string(),
                  fmt::format("it has no vertex {}", site.vertex),
                  "give the body.h5 that the curves were made with");
    }
    const std::int32_t node = body.response.node[static_cast<std::size_t>(site.vertex)];
    site.position = body.nodes[static_cast<std::size_t>(node)];
  }
}

/// Reads curves.h5 or library.h5.
compare::ComparedSet read_set(const fs::path& file, const std::string& body) {
  const std::string kind = artifact_kind(file, "give curves.h5 or library.h5");
  if (kind == "palpate.curves") {
    compare::ComparedSet set = compare::set_of(read_curves(file), file.string());
    if (!body.empty()) add_positions(set, body);
    return set;
  }
  if (kind == "palpate.library") return compare::set_of(read_library(file), file.string());
  throw Error(ErrorKind::Configuration, file.string(), "it is a " + kind + ", which has no curves",
              "give curves.h5 or library.h5");
}

std::string percentage(double value) {
  return std::isfinite(value) ? fmt::format("{:.0f} %", 100 * value) : std::string("unknown");
}

void print(const compare::Comparison& comparison) {
  for (const compare::Summary& s : comparison.summaries) {
    answer("  {}: {}, {}", s.kind == PathKind::Normal ? "normal" : "lateral",
           count_text(s.curves, "curve"), count_text(s.points, "point"));
    answer("    RMSE {} ({:.2g} % of the largest force), bias {}, limits of agreement {} to {}",
           force_text(s.rmse), 100 * s.normalised_rmse, force_text(s.bias),
           force_text(s.agreement_low), force_text(s.agreement_high));
    answer(
        "    {:.2g} just noticeable differences (root mean square), noticeable at {} of the points",
        s.jnd_rms, percentage(s.noticeable));
    answer("    scatter of the reference: {}; within the uncertainty: {} of the points",
           std::isfinite(s.mean_scatter) ? force_text(s.mean_scatter) : "unknown",
           percentage(s.within_uncertainty));
    answer("    largest error: site {} at {}, {} instead of {}", s.worst_vertex,
           length_text(s.worst.displacement), force_text(s.worst.model),
           force_text(s.worst.reference));
  }
  if (!comparison.unmatched.empty()) {
    answer("  without a partner: {} (listed in comparison.json)",
           count_text(comparison.unmatched.size(), "site or path", "sites or paths"));
  }
}

void write_comparison(const fs::path& out, const compare::Comparison& comparison,
                      const compare::CompareSettings& settings,
                      const nlohmann::ordered_json& digests) {
  auto json = comparison_json(comparison, settings);
  json["input_sha256"] = digests;
  write_file_crash_safely(out / "comparison.json", json.dump(1) + "\n");
  write_file_crash_safely(out / "comparison.csv", comparison_csv(comparison));
  write_file_crash_safely(out / "comparison-points.csv", comparison_points_csv(comparison));
}

bool differ_in_friction(const compare::ComparedSet& a, const compare::ComparedSet& b) {
  return !a.tool_friction.empty() && !b.tool_friction.empty() && a.tool_friction != b.tool_friction;
}

/// N, as asked for, or as the forces of the reference suggest.
double jnd_floor(const CompareOptions& options, const compare::ComparedSet& reference) {
  return std::isfinite(options.jnd_floor_mn)
             ? 1e-3 * options.jnd_floor_mn
             : compare::jnd_floor_of(reference, options.settings.jnd);
}

int compare_sets(CompareOptions options) {
  if (fs::path(options.reference).extension() == ".json") {
    compare_histories(options.reference, options.model, options.out);
    return kExitDone;
  }
  for (const double depth : options.depths_mm) options.settings.depths.push_back(1e-3 * depth);
  const auto reference = read_set(options.reference, options.reference_body);
  const auto model = read_set(options.model, options.model_body);
  options.settings.jnd_floor = jnd_floor(options, reference);
  options.settings.site_tolerance = std::isfinite(options.site_tolerance_mm)
                                        ? 1e-3 * options.site_tolerance_mm
                                        : compare::site_tolerance_of(reference);
  const compare::Comparison comparison = compare::compare(reference, model, options.settings);
  say("compare: {} against {}", options.model, options.reference);
  print(comparison);
  if (differ_in_friction(reference, model))
    warn(
        fmt::format("the tool of {} is {}, that of {} {}: that alone makes forces differ by "
                    "percents",
                    reference.name, reference.tool_friction, model.name, model.tool_friction));
  if (options.settings.jnd_floor < compare::CompareSettings{}.jnd_floor)
    answer("  a difference of {} counts as noticeable near zero force: the forces are small",
           force_text(options.settings.jnd_floor));
  const fs::path out = options.out;
  prepare_output(out);
  write_comparison(
      out, comparison, options.settings,
      {{"reference", sha256_of_file(options.reference)}, {"model", sha256_of_file(options.model)}});
  say("compare: {}, comparison.csv, comparison-points.csv", (out / "comparison.json").string());
  return kExitDone;
}

/// The sites of a measured case, each predicted from the others. The comparison of the curves goes
/// where the report of the case finds it.
int compare_left_out(CompareOptions options) {
  options.left_out.out = options.out;
  const Workspace space = open_workspace(options.left_out);
  if (!is_measured(space)) {
    refuse("case " + space.c.name, "has no [measured]: --leave-out is for measured sites",
           "compare a simulated one with --fem");
  }
  refuse_body_of_another_case(space);
  const Library library = read_input(space.library(), "build", read_library);
  const Curves curves = read_input(space.curves(), "build", read_curves);
  const LeaveOut result = leave_sites_out(library, curves);
  print_line(leave_out_text(result));
  const LeaveOutSets sets = sets_of(result, library, curves);
  options.settings.jnd_floor = jnd_floor(options, sets.measured);
  const compare::Comparison comparison =
      compare::compare(sets.measured, sets.predicted, options.settings);
  prepare_output(space.out);
  write_file_crash_safely(space.out / "leave-out.json",
                          leave_out_json(result, library).dump(1) + "\n");
  write_comparison(
      space.out, comparison, options.settings,
      {{"curves", sha256_of_file(space.curves())}, {"library", sha256_of_file(space.library())}});
  say("compare: {}, comparison.json, comparison.csv, comparison-points.csv",
      (space.out / "leave-out.json").string());
  return kExitDone;
}

int compare_with_fem(CompareOptions options) {
  options.fem.out = options.out;
  options.fidelity.floor = 1e-3 * options.floor_mn;
  for (const std::string& file : options.libraries) options.fidelity.libraries.emplace_back(file);
  if (!options.histories.empty()) {
    compare_histories_with_fem(open_workspace(options.fem), options.histories);
    return kExitDone;
  }
  const bool complete = run_fidelity(open_workspace(options.fem), options.fidelity);
  return complete ? kExitDone : kExitSomeSitesFailed;
}

void add_fem_options(CLI::App& command, CompareOptions& options, CLI::Option* sets) {
  CLI::Option* fem =
      command.add_option("--fem", options.fem.case_file,
                         "Case whose library is compared with direct solutions at hold-out points");
  fem->excludes(sets);
  const auto only_with_fem = [&](CLI::Option* option) {
    option->needs(fem);
    return option;
  };
  only_with_fem(command.add_option("--points", options.fidelity.off_node,
                                   "Number of hold-out points between the response vertices"))
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  only_with_fem(command.add_option("--nodes", options.fidelity.at_node,
                                   "Number of response vertices that are pressed again"))
      ->capture_default_str()
      ->check(CLI::Range(0, 100000));
  only_with_fem(command.add_option("--seed", options.fidelity.seed, "Seed of the random points"))
      ->capture_default_str();
  only_with_fem(
      command.add_option(
          "--floor", options.fidelity.floor_fraction,
          "Errors are relative to the direct force, or to this fraction of the force of the body "
          "(median of the largest direct forces) if that is larger"))
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 1.0));
  only_with_fem(command.add_option("--floor-mN", options.floor_mn,
                                   "The same as a force, mN, instead of a fraction"))
      ->excludes("--floor")
      ->check(CLI::Range(1e-6, 1e6));
  only_with_fem(command.add_flag(
      "--finer-mesh", options.fidelity.finer_mesh,
      "Press the hold-out points on a mesh with smaller elements under the tool, so that the error "
      "of the mesh of the case counts too"));
  only_with_fem(command.add_option("--library", options.libraries,
                                   "Libraries to compare (default: that of the case)"));
  only_with_fem(command.add_option(
      "--histories", options.histories,
      "histories.json: compare direct solutions with these records over time instead"));
  only_with_fem(command.add_option("--threads", options.fem.threads,
                                   "Threads (default: one for each processor)"))
      ->check(CLI::Range(1, 4096));
}

}  // namespace

void add_compare_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "compare",
      "Compares curves or libraries, simulated or measured, or a library with direct solutions");
  command->footer(
      "Examples:\n"
      "  palpate compare out/pad-measured/curves.h5 out/pad/curves.h5 --out out/pad\n"
      "  palpate compare out/held/histories.json out/pad/library.h5 --out out/held\n"
      "  palpate compare --fem data/cases/liver.toml\n"
      "  palpate compare --leave-out data/cases/liver-patch.toml");
  const auto options = std::make_shared<CompareOptions>();
  CLI::Option* reference = command->add_option(
      "REFERENCE", options->reference,
      "curves.h5, library.h5 or, over time, histories.json taken as the reference");
  CLI::Option* model = command->add_option("MODEL", options->model,
                                           "curves.h5 or library.h5 that is compared with it");
  reference->needs(model);
  add_fem_options(*command, *options, reference);
  command
      ->add_option("--leave-out", options->left_out.case_file,
                   "Measured case whose sites are each predicted from the others")
      ->excludes(reference)
      ->excludes("--fem");
  command->add_option("--reference-body", options->reference_body,
                      "body.h5 of the reference, to match sites by position");
  command->add_option("--model-body", options->model_body,
                      "body.h5 of the model, to match sites by position");
  command->add_option("--out", options->out,
                      "Folder of the tables; with a case, of the artifacts (default with a case: "
                      "output.folder of the case, or out/NAME)");
  command
      ->add_option("--jnd", options->settings.jnd, "Just noticeable relative difference of force")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 1.0));
  command
      ->add_option("--jnd-floor-mN", options->jnd_floor_mn,
                   "Smallest noticeable difference, mN (default: 5, or the just noticeable part of "
                   "the largest force where that is less)")
      ->check(CLI::Range(1e-6, 1e6));
  command
      ->add_option("--site-tolerance-mm", options->site_tolerance_mm,
                   "Largest distance between matched sites of two bodies, mm (default: 2, or twice "
                   "the radius of the tool where that is less)")
      ->check(CLI::Range(1e-6, 1e6));
  command->add_option("--depths-mm", options->depths_mm,
                      "Depths at which stiffness is compared, mm (default: thirds of the range)");
  command->callback([options, &action] {
    const bool has_case = !options->fem.case_file.empty() || !options->left_out.case_file.empty();
    if (options->reference.empty() && !has_case)
      throw CLI::RequiredError("REFERENCE and MODEL, --fem CASE or --leave-out CASE");
    if (options->out.empty() && !has_case) throw CLI::RequiredError("--out");
    action = [options] {
      if (!options->left_out.case_file.empty()) return compare_left_out(*options);
      return options->fem.case_file.empty() ? compare_sets(*options) : compare_with_fem(*options);
    };
  });
}

}  // namespace palpate::app
