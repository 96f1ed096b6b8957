// SPDX-License-Identifier: AGPL-3.0-or-later
// Expected refusals: the kind, the place, the problem with its figures, and a remedy.
#pragma once

#include <filesystem>
#include <string>

#include "format/error.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/settings.hpp"

namespace palpate::mesher::test {

/// A cube of 50 mm with a corner at the origin.
Surface cube();

/// Patches and elements of 10 mm, fixed at z <= 1 mm.
Settings settings_for(const std::filesystem::path& path, double unit = 1);

/// Expects that mesh(settings) throws an error of this kind whose parts contain these texts.
void expect_refused(const Settings& settings, const std::string& where, const std::string& problem,
                    const std::string& remedy, ErrorKind kind = ErrorKind::Geometry);

/// Writes a surface file and expects that it is refused.
void expect_file_refused(const std::string& name, const std::string& content,
                         const std::string& problem, const std::string& remedy);

}  // namespace palpate::mesher::test
