// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <utility>

#include "format/error.hpp"
#include "format/provenance.hpp"

namespace palpate::app {

/// Reads the artifact of an earlier stage; the remedy of a missing one names that stage.
template <class Read>
auto read_input(const std::filesystem::path& path, const char* made_by, Read read) {
  if (!std::filesystem::exists(path)) {
    throw Error(ErrorKind::Configuration, path.string(), "the file does not exist",
                std::string("make it with `palpate ") + made_by + "`");
  }
  return read(path);
}

/// The provenance of an artifact: that of its input and one more step.
inline void append(Provenance& provenance, const Provenance& before, ProvenanceStep step) {
  provenance = before;
  provenance.steps.push_back(std::move(step));
}

}  // namespace palpate::app
