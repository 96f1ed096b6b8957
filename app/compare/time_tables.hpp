// SPDX-License-Identifier: AGPL-3.0-or-later
// A comparison over time as tables.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fitting/measurement/compare/over_time.hpp"

namespace palpate::app {

/// A record and what a model makes of it.
struct ComparedHistory {
  std::string record;
  std::int32_t vertex = -1;
  std::string model;  ///< "library", or "direct" for a direct solution
  compare::TimeComparison comparison;
};

/// All but the samples, and the samples; unknown values are null.
nlohmann::ordered_json time_comparison_json(const std::vector<ComparedHistory>& compared);
/// One row a sample: record, model, time, travel, forces and error.
std::string time_comparison_csv(const std::vector<ComparedHistory>& compared);
void say_time_comparison(const std::vector<ComparedHistory>& compared);

}  // namespace palpate::app
