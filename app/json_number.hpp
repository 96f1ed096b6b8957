// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace palpate::app {

/// A number of an account: JSON has neither NaN nor infinity, an unknown value is null.
inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace palpate::app
