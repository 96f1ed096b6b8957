// SPDX-License-Identifier: AGPL-3.0-or-later
// histories.json: records of `palpate import` that are kept whole, over time.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fitting/measurement/records/history.hpp"
#include "format/curves.hpp"

namespace palpate::app {

using measured::SiteHistory;

struct Histories {
  std::string name, specimen, source, licence;
  std::string body_sha256;  ///< empty: of no body
  ToolDescription tool;     ///< radius 0: between plates
  std::vector<SiteHistory> records;
};

/// The file, complete. Arrays hold one number a sample; phases are samples begin .. end - 1.
nlohmann::ordered_json histories_json(const Histories& histories);

/// @throws Error(Configuration) naming the file for a file of another kind, arrays of different
///   lengths, times that do not increase, phases beyond the record.
Histories read_histories(const std::filesystem::path& file);

/// read_histories(), and every record is at a site of a body.
/// @throws Error(Configuration) also for a record without a site.
Histories histories_with_sites(const std::filesystem::path& file);

/// @throws Error(Configuration) naming `where` unless shape and radius (m, within 1 %) are those of
///   the tool of the records.
void require_same_tool(const Histories& histories, const std::string& shape, double radius,
                       const std::string& where);

}  // namespace palpate::app
