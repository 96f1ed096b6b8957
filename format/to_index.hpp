// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace palpate {

/// Numbers of nodes, elements and unknowns are stored as `int`, as CHOLMOD and the files have them;
/// containers count in std::size_t. Only for numbers that are not negative.
constexpr std::size_t to_index(int number) {
  return static_cast<std::size_t>(number);
}

}  // namespace palpate
