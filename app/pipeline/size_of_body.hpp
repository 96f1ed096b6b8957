// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "app/case/case.hpp"
#include "mesher/settings.hpp"

namespace palpate::app {

/// The box around the body as its file describes it: the points of the surface or of the volume
/// mesh, or the voxels of the labels of the image.
/// @param folder  of the case, which the paths are relative to
/// @throws Error(Geometry) for a file that cannot be read or bounds nothing.
BodySize size_of_body(const mesher::Settings& mesh, const std::filesystem::path& folder);

}  // namespace palpate::app
