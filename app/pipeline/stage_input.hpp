// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <utility>

#include "format/error.hpp"
#include "format/provenance.hpp"

namespace palpate::app {

/// An artifact of the stage before, with a remedy that names that stage.
template <class Read>
auto read_input(const std::filesystem::path& path, const char* made_by, Read read) {
  if (!std::filesystem::exists(path)) {
    throw Error(ErrorKind::Configuration, path.string(), "the file does not exist",
                std::string("make it with `palpate ") + made_by + "`");
  }
  return read(path);
}

/// The provenance of what a stage makes: that of its input and one step more.
inline void append(Provenance& provenance, const Provenance& before, ProvenanceStep step) {
  provenance = before;
  provenance.steps.push_back(std::move(step));
}

}  // namespace palpate::app
