// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace palpate::app {

/// Contents of an artifact of any kind, as a tree. A number with a unit is {"value": number,
/// "unit": text}, or {"value": null, "unit": text, "why": text} when it is not finite. The
/// provenance is complete. Reads and checks the whole file.
/// @throws Error(Configuration) when the file is not an artifact of palpate or is damaged.
nlohmann::ordered_json summarize_artifact(const std::filesystem::path& file);

/// The same as text: one line for each value, indented, without the resolved cases.
std::string summary_text(const nlohmann::ordered_json& summary);

}  // namespace palpate::app
