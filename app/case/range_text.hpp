// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "app/case/describe/key.hpp"

namespace palpate::app {

/// "> 0 mm", "0 .. 0.5, upper end excluded", "any finite value": for messages and the reference.
std::string range_text(const Range& range, std::optional<Dimension> dimension = std::nullopt);

}  // namespace palpate::app
