// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "format/body.hpp"
#include "mesher/settings.hpp"

namespace palpate::app {

/// The body of the settings. Where a surface is refused for some of its faces, these are written to
/// `faulty-faces.vtp` in the folder, in the unit of the surface file, and the message names it; a
/// file of an earlier refusal is removed.
/// @throws Error as mesher::mesh
Body mesh_surface(const mesher::Settings& settings, const std::filesystem::path& folder);

}  // namespace palpate::app
