// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/read/vtk/vtk_data.hpp"

namespace palpate::mesher {

/// Reads a VTK XML file of type UnstructuredGrid (VTU) or PolyData (VTP): pieces joined, arrays as
/// text, base64, or appended raw or as base64, uncompressed or by zlib.
/// @throws Error(Geometry) with the line and the name of the array.
VtkData read_vtk_xml(std::string_view bytes, const std::string& file);

}  // namespace palpate::mesher
