// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/nearest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace palpate::app {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::string_view nearest(std::string_view word, const std::vector<std::string_view>& known) {
  const auto closest =
      std::min_element(known.begin(), known.end(), [word](std::string_view a, std::string_view b) {
        return edit_distance(word, a) < edit_distance(word, b);
      });
  return closest == known.end() ? std::string_view{} : *closest;
}

bool is_like(std::string_view word, std::string_view other) {
  return 2 * edit_distance(word, other) <= other.size();
}

std::string meant_instead(std::string_view word, const std::vector<std::string_view>& known,
                          std::string_view what) {
  const std::string_view other = nearest(word, known);
  if (is_like(word, other)) return fmt::format("{} is '{}'", what, other);
  return fmt::format("known are {}", fmt::join(known, ", "));
}

}  // namespace palpate::app
