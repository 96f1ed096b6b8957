// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/touch.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "app/report/embed.hpp"
#include "format/flat_library.hpp"

namespace palpate::report {
namespace {

nlohmann::json byte_column(std::string_view bytes) {
  return column(std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
}

bool has_response(const NodeResponse& response) {
  return response.status != ResponseStatus::Hole;
}

}  // namespace

nlohmann::json touch_data(const Library& library) {
  const auto& responses = library.responses;
  if (runtime_wasm().empty() || std::none_of(responses.begin(), responses.end(), has_response))
    return nullptr;
  return {{"runtime", byte_column(runtime_wasm())},
          {"library", byte_column(flat_bytes(library, "the library of the report"))}};
}

}  // namespace palpate::report
