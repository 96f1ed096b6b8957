// SPDX-License-Identifier: AGPL-3.0-or-later
// The preview: one HTML file that shows a body before anything is computed on it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "format/body.hpp"

namespace palpate::report {

/// Data of the page, lengths in m.
/// @param repair  text of repair.json; empty: the surface was not repaired
/// @throws Error(Configuration) when the text is not a repair.json.
nlohmann::json preview_data(const Body& body, const std::string& repair);

/// The body with its supports, press zones and sites, in the colours of the distance that repair
/// moved the surface, where that is known; a file as that of write_report.
/// @throws Error as preview_data, Error(Internal) when the file cannot be written.
void write_preview(const Body& body, const std::string& repair, const std::filesystem::path& path);

}  // namespace palpate::report
