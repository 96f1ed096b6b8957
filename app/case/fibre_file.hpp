// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "fem/laws/fibre_samples.hpp"

namespace palpate::app {

/// Reads fibre directions at points: a line `x,y,z,fx,fy,fz` or `x,y,z,fx,fy,fz,sx,sy,sz` that
/// names the columns, then one line for each point. x, y, z in units of `unit` metres; f is the
/// direction of the fibres and s the second direction of their plane, both of any length. Empty
/// lines and comments after `#` are skipped.
/// @throws Error(Configuration) with the number of an invalid line.
std::vector<fem::FibreSample> read_fibre_file(const std::filesystem::path& path, double unit);

}  // namespace palpate::app
