// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

namespace palpate::app {

struct Sidecar;
class SourceMap;

/// Makes of each section with a pattern or a list one section for each file, in the order of the
/// names or of the rows, with what varies filled in.
/// @throws Error(Configuration) at the section: none or several of file, files and list, nothing
///   that matches, a placeholder that nothing gives, a text that is no number or quantity.
void expand_files(Sidecar& sidecar, const std::filesystem::path& folder, const SourceMap& sources);

}  // namespace palpate::app
