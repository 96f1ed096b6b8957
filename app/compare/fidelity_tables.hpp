// SPDX-License-Identifier: AGPL-3.0-or-later
// The fidelity of a library as tables.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/compare/fidelity_run.hpp"
#include "fitting/fidelity/fidelity.hpp"
#include "fitting/fidelity/skin_error.hpp"

namespace palpate::app {

struct LibrarySize {
  double curves_per_node = 0;  ///< bytes of knots and slopes
  std::uintmax_t file = 0;     ///< bytes
};

/// One line: what errors are relative to. floor: N.
std::string floor_text(const FidelityOptions& options, double floor);
/// Plain text, one line per row.
std::string fidelity_text(const std::string& file, const fidelity::Fidelity& fidelity,
                          const LibrarySize& size);
/// One line per state; starts with the column names when `heading`.
std::string fidelity_states_csv(const std::string& file, const fidelity::Fidelity& fidelity,
                                bool heading);
/// Common to all libraries: settings and points.
nlohmann::ordered_json fidelity_heading(const FidelityOptions& options,
                                        const fidelity::FidelitySettings& settings,
                                        const std::vector<fidelity::HoldOutPoint>& points);
nlohmann::ordered_json fidelity_json(const std::filesystem::path& file,
                                     const fidelity::Fidelity& fidelity, const LibrarySize& size);

/// The errors of the skin in the same form; empty without rows.
std::string skin_error_text(const std::vector<fidelity::SkinErrorRow>& rows);
nlohmann::ordered_json skin_error_json(const std::vector<fidelity::SkinErrorRow>& rows);

}  // namespace palpate::app
