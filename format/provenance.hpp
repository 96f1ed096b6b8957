// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace palpate {

class Checks;

/// One input file of a stage.
struct InputDigest {
  std::string name;    ///< file name without its folder
  std::string sha256;  ///< of its bytes, 64 hexadecimal digits
};

/// One stage of the pipeline, as it was run.
struct ProvenanceStep {
  std::string stage;          ///< "mesh", "precompute", "fit", "certify"
  std::string version;        ///< of palpate
  std::string git_revision;   ///< of the build; "-dirty" appended when the tree had changes
  std::string utc;            ///< when the stage ended, ISO 8601, "2026-01-31T12:00:00Z"
  std::string resolved_case;  ///< the case as understood, defaults filled in, TOML
  std::vector<InputDigest> inputs;
  std::vector<std::pair<std::string, std::string>> facts;  ///< library versions, BLAS kernel, ...
};

/// Every stage an artifact has been through, oldest first. An artifact carries the provenance of
/// all the artifacts it was made from.
struct Provenance {
  std::vector<ProvenanceStep> steps;
};

/// A step of this build of palpate that ends now: fills in version, git revision, time and the
/// digests of the input files. @throws Error when an input cannot be read.
ProvenanceStep make_provenance_step(std::string stage, std::string resolved_case,
                                    const std::vector<std::filesystem::path>& inputs,
                                    std::vector<std::pair<std::string, std::string>> facts = {});

/// Name of the group of a step in a file: /provenance/<NN>_<stage>.
std::string provenance_group(std::size_t position, const std::string& stage);

/// At most 100 steps, each with a stage, and digests that are some.
void check_provenance(const Checks& checks, const Provenance& provenance);

/// "palpate <version> (<git revision>)" of this build.
std::string creator_text();

}  // namespace palpate
