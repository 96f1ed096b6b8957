// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "format/body.hpp"
#include "mesher/settings.hpp"

namespace palpate::app {

/// The body of the settings. Where a surface is refused for some of its faces, these are written to
/// `faulty-faces.vtp` in the folder, in the unit of the surface file, and the message names it.
/// Where the outer surface was repaired, `repair.json` shows it beside that of the file. Files of
/// an earlier run are removed.
/// @throws Error as mesher::mesh
Body mesh_surface(mesher::Settings settings, const std::filesystem::path& folder);

}  // namespace palpate::app
