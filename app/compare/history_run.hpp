// SPDX-License-Identifier: AGPL-3.0-or-later
// Records over time against what a library, or the finite element model, makes of their motion.
#pragma once

#include <filesystem>

#include "app/pipeline/workspace.hpp"

namespace palpate::app {

/// Each record of histories.json is followed by the runtime on the library. Writes over-time.json,
/// over-time.csv and over-time.html to the folder.
/// @throws Error(Configuration) for records without a site, sites that the library lacks, and
///   another tool.
void compare_histories(const std::filesystem::path& histories, const std::filesystem::path& library,
                       const std::filesystem::path& out);

/// The same against direct solutions of the case, and its library where the folder holds one.
void compare_histories_with_fem(const Workspace& space, const std::filesystem::path& histories);

}  // namespace palpate::app
