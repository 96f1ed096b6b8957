// SPDX-License-Identifier: Apache-2.0
#include "format/provenance.hpp"

#include <array>
#include <cctype>
#include <cstddef>
#include <ctime>

#include "format/checks.hpp"
#include "format/sha256.hpp"
#include "palpate_version.hpp"

namespace palpate {
namespace {

constexpr std::size_t kMostSteps = 100;  // two digits in the name of a group

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
#if defined(_WIN32)
  gmtime_s(&utc, &now);
#else
  gmtime_r(&now, &utc);
#endif
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), length};
}

}  // namespace

std::string provenance_group(std::size_t position, const std::string& stage) {
  std::string name = position < 10 ? "0" + std::to_string(position) : std::to_string(position);
  name += '_';
  for (const char c : stage) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  }
  return "/provenance/" + name;
}

ProvenanceStep make_provenance_step(std::string stage, std::string resolved_case,
                                    const std::vector<std::filesystem::path>& inputs,
                                    std::vector<std::pair<std::string, std::string>> facts) {
  ProvenanceStep step;
  step.stage = std::move(stage);
  step.version = PALPATE_VERSION;
  step.git_revision = PALPATE_GIT_REVISION;
  step.resolved_case = std::move(resolved_case);
  for (const std::filesystem::path& input : inputs) {
    step.inputs.push_back({input.filename().string(), sha256_of_file(input)});
  }
  step.facts = std::move(facts);
  step.utc = utc_now();
  return step;
}

std::string creator_text() {
  return std::string("palpate ") + PALPATE_VERSION + " (" + PALPATE_GIT_REVISION + ")";
}

void check_provenance(const Checks& checks, const Provenance& provenance) {
  checks.require(provenance.steps.size() <= kMostSteps, "/provenance", "has over 100 steps");
  for (std::size_t i = 0; i < provenance.steps.size(); ++i) {
    const ProvenanceStep& step = provenance.steps[i];
    const std::string group = provenance_group(i, step.stage);
    checks.require(!step.stage.empty(), group + "@stage", "is empty");
    for (const InputDigest& input : step.inputs) {
      checks.digest(group + "@input_sha256", input.sha256, false);
    }
  }
}

}  // namespace palpate
