// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace palpate::app {

/// What an artifact holds, whatever its kind, as a tree: numbers with a unit are
/// {"value": number, "unit": text}, or {"value": null, "unit": text, "why": text} where there is no
/// such number; the provenance is complete. The whole file is read and checked.
/// @throws Error(Configuration) when the file is no artifact of palpate or is damaged.
nlohmann::ordered_json summarize_artifact(const std::filesystem::path& file);

/// The same for a reader: one line a value, indented, long texts of the provenance left out.
std::string summary_text(const nlohmann::ordered_json& summary);

}  // namespace palpate::app
