// SPDX-License-Identifier: AGPL-3.0-or-later
// Data in a form that is safe inside an HTML file.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::report {

/// JSON for a <script type="application/json"> element: '<', '>' and '&' are escaped, so the data
/// cannot end the element; bytes that are not UTF-8 become U+FFFD; NaN and infinity null.
std::string script_json(const nlohmann::json& value);

/// A column of numbers as {"<type>": base64 of little-endian bytes}; the page decodes it into a
/// typed array. The type is one of f4 (float), i4, u4, u2, u1.
nlohmann::json column(const std::vector<float>& values);
nlohmann::json column(const std::vector<std::int32_t>& values);
nlohmann::json column(const std::vector<std::uint32_t>& values);
nlohmann::json column(const std::vector<std::uint16_t>& values);
nlohmann::json column(const std::vector<std::uint8_t>& values);

/// Bytes as {"z1": base64 of a stream of zlib}: for files of megabytes. The page inflates them.
nlohmann::json packed_column(std::string_view bytes);

/// A column in the narrowest type that holds every value: u2, u4, or i4 when one is negative.
nlohmann::json index_column(const std::vector<std::int32_t>& values);
/// Numbers in 0..1 in steps of 1/65535, for pictures.
nlohmann::json fraction_column(const std::vector<double>& values);

}  // namespace palpate::report
