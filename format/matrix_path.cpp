// SPDX-License-Identifier: Apache-2.0
#include "format/matrix_path.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

#include "format/error.hpp"
#include "format/text.hpp"

namespace palpate {
namespace {

int index_of(std::string_view text, const std::string& where) {
  int value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure == std::errc{} && end == text.data() + text.size() && value >= 1) return value;
  refuse(where, "'" + std::string(text) + "' is no column or row",
         "write (:,2) for the second column, (2,:) for the second row");
}

}  // namespace

MatrixPath matrix_path(const std::string& path, const std::string& where) {
  const std::size_t open = path.rfind('('), comma = path.rfind(',');
  const bool is_choice = path.ends_with(')') && open != std::string::npos && open > 0 &&
                         comma != std::string::npos && comma > open;
  if (!is_choice) return {path, 0, 0};
  const std::string_view inside = std::string_view(path).substr(open + 1);
  const std::string_view rows = trimmed(inside.substr(0, comma - open - 1));
  const std::string_view columns =
      trimmed(inside.substr(comma - open, inside.size() - (comma - open) - 1));
  const std::string base = path.substr(0, open);
  if (rows == ":") return {base, index_of(columns, where), 0};
  if (columns == ":") return {base, 0, index_of(rows, where)};
  refuse(where, "it chooses neither a column nor a row",
         "write (:,2) for the second column, (2,:) for the second row");
}

void check_finite(const std::vector<double>& values, const std::string& where) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    refuse(where,
           "value " + std::to_string(i + 1) + " of " + std::to_string(values.size()) +
               (std::isnan(values[i]) ? " is NaN" : " is infinite"),
           "store the record without gaps");
  }
}

}  // namespace palpate
