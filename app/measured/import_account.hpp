// SPDX-License-Identifier: AGPL-3.0-or-later
// What import.json says of records and sites.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "fitting/measurement/records/csv_table.hpp"
#include "fitting/measurement/records/press.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// Where a press was placed.
struct PlacedAt {
  int vertex = -1;
  double distance = 0;  ///< m, from the measured point
};

/// A press of a record, its baseline and its contact point.
nlohmann::ordered_json press_account(const std::string& file, const measured::CsvTable& table,
                                     const PlacedAt& place, const measured::PressCurve& curve);

/// The paths of each site at their ends.
nlohmann::ordered_json sites_account(const Curves& curves);

}  // namespace palpate::app
