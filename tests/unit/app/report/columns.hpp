// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "format/base64.hpp"

namespace palpate::report {

/// The numbers of a column of the page.
inline std::vector<float> floats(const nlohmann::json& column) {
  const std::string bytes = from_base64(column.front().get<std::string>()).value();
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

}  // namespace palpate::report
