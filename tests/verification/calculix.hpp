// SPDX-License-Identifier: AGPL-3.0-or-later
// CalculiX as an independent solver: a deck goes in, what it prints comes out.
#pragma once

#include <array>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace palpate::test {

/// What CalculiX prints of a deck. A run that fails is a failure of the test.
std::string printed_by_calculix(const std::string& deck);

/// The numbers below each line with this text.
template <std::size_t N>
std::vector<std::array<double, N>> numbers_below(const std::string& title,
                                                 const std::string& text) {
  std::vector<std::array<double, N>> found;
  std::istringstream printed(text);
  for (std::string line; std::getline(printed, line);) {
    if (line.find(title) == std::string::npos) continue;
    for (double& x : found.emplace_back()) printed >> x;
  }
  return found;
}

}  // namespace palpate::test
