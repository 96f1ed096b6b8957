// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/measured/histories.hpp"
#include "app/measured/sidecar.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// What `palpate import` makes: curves like those of a campaign, records kept whole, and an account
/// of each record.
// NOLINTNEXTLINE(bugprone-exception-escape): moving the JSON value is not seen to be safe
struct Import {
  Curves curves;        ///< without sites where the sidecar has histories alone
  Histories histories;  ///< of the [[history]] records; may be none
  nlohmann::ordered_json account;
  int refused = 0;  ///< records and sites that are not in the curves; the account has the reasons
};

/// Read all records of a sidecar and locate them on the body. Presses of one site are repeats: they
/// become one path with their scatter; so do drags of one site, depth and direction stay apart.
/// @param body_file  body.h5, or empty: the vertices of the sidecar are taken as they are, the
///   presses run along -z, and the curves refer to no body.
/// A record that cannot be used is left out and listed in the account, as long as another can.
/// @param records  restricts the sidecar to these; empty: all. Those that it does not name are
///   refused.
/// @param tool  whose records are taken, see read_sidecar.
/// @throws Error(Configuration) naming record and line, where nothing can be used.
Import import_measurement(const std::filesystem::path& sidecar_file,
                          const std::filesystem::path& body_file,
                          const std::vector<std::filesystem::path>& records = {},
                          const std::string& tool = {});

/// The [[history]] records of a sidecar alone, without their sites: no body is needed.
/// @throws Error(Configuration) as import_measurement.
Histories import_histories(const std::filesystem::path& sidecar_file);

}  // namespace palpate::app
