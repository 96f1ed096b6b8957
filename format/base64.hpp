// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate {

/// The bytes in base64 with padding [RFC 4648, 4].
std::string base64(std::string_view bytes);

/// The bytes that a text of base64 stands for. Nothing where it holds other characters, lacks its
/// padding, or goes on behind it.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace palpate
