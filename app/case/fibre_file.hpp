// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "fem/laws/fibre_samples.hpp"

namespace palpate::app {

/// Directions of fibres at points, as text: a line `x,y,z,fx,fy,fz` or `x,y,z,fx,fy,fz,sx,sy,sz`
/// that names the columns, then one line for each point. x, y, z in `unit` metres; f the direction
/// of the fibres, s the second direction of their plane, both of any length. Empty lines and what
/// follows a
/// `#` are passed over.
/// @throws Error(Configuration) with the line where the file cannot be read so.
std::vector<fem::FibreSample> read_fibre_file(const std::filesystem::path& path, double unit);

}  // namespace palpate::app
