// SPDX-License-Identifier: AGPL-3.0-or-later
// A comparison as tables.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "fitting/measurement/compare/compare.hpp"

namespace palpate::app {

/// One row per curve: its measures.
std::string comparison_csv(const compare::Comparison& comparison);
/// One row per point: the aligned curves.
std::string comparison_points_csv(const compare::Comparison& comparison);
/// The complete comparison; unknown values are null.
nlohmann::ordered_json comparison_json(const compare::Comparison& comparison,
                                       const compare::CompareSettings& settings);

}  // namespace palpate::app
