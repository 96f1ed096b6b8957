// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "format/curves.hpp"
#include "format/recording.hpp"

namespace palpate::app {

/// All samples of all paths, one row each, with a title row that carries the SI units:
/// vertex, status, path, lateral depth, direction, displacement, force, energies and checks.
/// Numbers read back exactly.
std::string curves_csv(const Curves& curves);

/// Written crash-safe.
void write_curves_csv(const Curves& curves, const std::filesystem::path& file);

/// Every step of a session that was not yet read, one row each, with a title row that carries the
/// SI units; a few thousand steps in memory. Written crash-safe.
void write_recording_csv(RecordingReader& recording, const std::filesystem::path& file);

}  // namespace palpate::app
