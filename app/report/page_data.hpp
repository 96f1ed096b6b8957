// SPDX-License-Identifier: AGPL-3.0-or-later
// The data of the page as one JSON value, in SI units.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/report/report.hpp"
#include "app/report/surface_map.hpp"

namespace palpate::report {

/// @throws Error(Configuration) when the artifacts do not fit together.
nlohmann::json page_data(const ReportInput& input);

/// The paths of all sites, and what is rendered in their states: of a drag the force along it more
/// than at its start, N. Columns of displacement, force, rendered and volume_change from `offset`.
nlohmann::json sample_data(const Curves& curves, const Library& library);

/// Name, sizes and regions of a body.
nlohmann::json body_data(const Body& body);
/// Index of each of the triangles in the library, -1 where the library lacks it.
std::vector<std::int32_t> library_triangles(const std::vector<Triangle>& triangles,
                                            const Library& library);
/// The boundary of a body on its response surface, for the picture.
nlohmann::json surface_data(const Body& body, const Library& library, const SurfaceMap& map);
/// Curves of all vertices in sequence, delimited by offsets: of straight presses or of the lateral
/// responses.
nlohmann::json response_columns(const Library& library, bool normal);
/// Surfaces of the regions inside.
nlohmann::json inclusion_data(const Body& body);
/// Data of the sections of the page.
nlohmann::json session_data(const SessionDigest& session);
nlohmann::json certificate_data(const Library& library);
/// @throws Error(Configuration) when the text is not a comparison of these vertices.
nlohmann::json comparison_data(const std::string& text, std::size_t vertices);
/// @throws Error(Configuration) when the text is not a calibration.
nlohmann::json calibration_data(const std::string& text);
/// Fidelity of the library of this digest; {"other_library": true} when the text is of another one.
/// @throws Error(Configuration) when the text is not a fidelity.json.
nlohmann::json fidelity_data(const std::string& text, const std::string& library_sha256);
/// Presses of a vertex at three speeds, and one that is held, as the runtime renders them; null
/// where the responses do not relax.
nlohmann::json relaxation_data(const Library& library, std::int32_t vertex);
nlohmann::json provenance_data(const ReportInput& input);
nlohmann::json provenance_data(const std::vector<ProvenanceStep>& steps);
/// The [[material]] tables of a resolved case, each a list of [key, value].
nlohmann::json materials(const std::string& resolved_case);

}  // namespace palpate::report
