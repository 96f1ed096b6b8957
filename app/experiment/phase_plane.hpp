// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/experiment/slingshot.hpp"

namespace palpate::app {

struct PhasePlane {
  std::string title;
  std::vector<PhasePoint> path;
};

/// Position against velocity, one panel each, side by side, as an SVG picture.
/// @throws Error(Internal) when the file cannot be written.
void write_phase_planes(const std::filesystem::path& file, const std::vector<PhasePlane>& planes);

/// position_m,velocity_m_per_s, a line for each sample. @throws as above.
void write_phase_csv(const std::filesystem::path& file, const std::vector<PhasePoint>& path);

}  // namespace palpate::app
