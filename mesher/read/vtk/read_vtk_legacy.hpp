// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/read/vtk/vtk_data.hpp"

namespace palpate::mesher {

/// Reads a legacy VTK file of the versions 1 to 5.1, text or binary, with a data set of the kind
/// UNSTRUCTURED_GRID or POLYDATA.
/// @throws Error(Geometry) with the place in the file.
VtkData read_vtk_legacy(std::string_view bytes, const std::string& file);

}  // namespace palpate::mesher
