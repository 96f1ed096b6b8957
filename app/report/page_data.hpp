// SPDX-License-Identifier: AGPL-3.0-or-later
// Everything the page shows, as one JSON value. SI throughout; the page scales for the reader.
#pragma once

#include <nlohmann/json.hpp>

#include "app/report/report.hpp"

namespace palpate::report {

/// @throws Error(Configuration) when the artifacts do not fit together.
nlohmann::json page_data(const ReportInput& input);

/// Parts of it, one for each section of the page.
nlohmann::json session_data(const SessionDigest& session);
nlohmann::json certificate_data(const Library& library);
/// @throws Error(Configuration) when the text is no comparison of these vertices.
nlohmann::json comparison_data(const std::string& text, std::size_t vertices);
/// What a judgement says of the library of this digest; {"other_library": true} when it says
/// nothing of it. @throws Error(Configuration) when the text is no judgement.
nlohmann::json fidelity_data(const std::string& text, const std::string& library_sha256);
nlohmann::json provenance_data(const ReportInput& input);
/// The [[material]] tables of a resolved case, each a list of [key, value], as written there.
nlohmann::json materials(const std::string& resolved_case);

}  // namespace palpate::report
