// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/freshness.hpp"

#include <algorithm>
#include <utility>

#include "app/case/reader.hpp"
#include "format/sha256.hpp"
#include "palpate_version.hpp"

namespace palpate::app {
namespace {

/// Name of the fact with the part of the case that the stage depends on.
constexpr const char* kSettingsFact = "stage_case";

std::string fact(const ProvenanceStep& step, const std::string& name) {
  const auto found = std::find_if(step.facts.begin(), step.facts.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  return found == step.facts.end() ? std::string{} : found->second;
}

bool same_inputs(const ProvenanceStep& step, const std::vector<std::filesystem::path>& files) {
  if (step.inputs.size() != files.size()) return false;
  return std::equal(files.begin(), files.end(), step.inputs.begin(),
                    [](const std::filesystem::path& file, const InputDigest& then) {
                      return std::filesystem::exists(file) && sha256_of_file(file) == then.sha256;
                    });
}

}  // namespace

ProvenanceStep make_stage_step(const Workspace& space, Stage stage,
                               std::vector<std::pair<std::string, std::string>> facts) {
  facts.emplace_back(kSettingsFact, stage_case(space, stage));
  return make_provenance_step(stage_name(stage), resolved_toml(space.c), stage_inputs(space, stage),
                              std::move(facts));
}

std::string case_name(const Provenance& provenance) {
  for (const ProvenanceStep& step : provenance.steps)
    if (step.stage == stage_name(Stage::Mesh))
      return parse_toml(step.resolved_case, "provenance")["name"].value_or(std::string());
  return {};
}

std::string stale_reason(const Workspace& space, Stage stage, const Provenance& provenance) {
  const std::string name = stage_name(stage);
  const auto last = std::find_if(provenance.steps.rbegin(), provenance.steps.rend(),
                                 [&](const ProvenanceStep& step) { return step.stage == name; });
  if (last == provenance.steps.rend()) return "this stage has not run";
  if (last->version != PALPATE_VERSION) return "it was made by version " + last->version;
  if (fact(*last, kSettingsFact) != stage_case(space, stage)) return "the case has changed";
  if (!same_inputs(*last, stage_inputs(space, stage))) return "an input file has changed";
  return {};
}

}  // namespace palpate::app
