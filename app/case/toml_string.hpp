// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace palpate::app {

/// The text as a TOML basic string, with its quotation marks.
std::string toml_string(std::string_view text);

}  // namespace palpate::app
