// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/embed.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "format/base64.hpp"
#include "format/error.hpp"

namespace palpate::report {

namespace {

template <class Number>
nlohmann::json typed_column(const char* type, const std::vector<Number>& values) {
  static_assert(std::endian::native == std::endian::little, "columns are little-endian");
  const auto* bytes = reinterpret_cast<const char*>(values.data());
  return {{type, base64(std::string_view(bytes, values.size() * sizeof(Number)))}};
}

}  // namespace

std::string script_json(const nlohmann::json& value) {
  const std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    // These three occur only inside JSON strings, where the escapes mean the same character.
    switch (c) {
      case '<':
        out += "\\u003c";
        break;
      case '>':
        out += "\\u003e";
        break;
      case '&':
        out += "\\u0026";
        break;
      default:
        out += c;
    }
  }
  return out;
}

nlohmann::json column(const std::vector<float>& values) {
  return typed_column("f4", values);
}
nlohmann::json column(const std::vector<std::int32_t>& values) {
  return typed_column("i4", values);
}
nlohmann::json column(const std::vector<std::uint32_t>& values) {
  return typed_column("u4", values);
}
nlohmann::json column(const std::vector<std::uint8_t>& values) {
  return typed_column("u1", values);
}

nlohmann::json column(const std::vector<std::uint16_t>& values) {
  return typed_column("u2", values);
}

nlohmann::json packed_column(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  const int result =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_COMPRESSION);
  if (result != Z_OK) {
    throw Error(ErrorKind::Internal, "report", "zlib could not compress a column",
                "free memory and write it again");
  }
  packed.resize(size);
  return {{"z1", base64(packed)}};
}

nlohmann::json index_column(const std::vector<std::int32_t>& values) {
  if (values.empty()) return column(values);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*low < 0) return column(values);
  if (*high > 0xffff) return column(std::vector<std::uint32_t>(values.begin(), values.end()));
  std::vector<std::uint16_t> narrow;
  narrow.reserve(values.size());
  for (const std::int32_t value : values) narrow.push_back(static_cast<std::uint16_t>(value));
  return column(narrow);
}

nlohmann::json fraction_column(const std::vector<double>& values) {
  std::vector<std::uint16_t> steps;
  steps.reserve(values.size());
  for (const double value : values)
    steps.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, 1.0) * 65535)));
  return column(steps);
}

}  // namespace palpate::report
