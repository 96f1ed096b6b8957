// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstddef>

namespace palpate::fem {

/// Numbers of nodes, elements and unknowns are stored as `int`, as CHOLMOD and the files have them;
/// containers count in std::size_t. Only for numbers that are not negative.
constexpr std::size_t at(int number) {
  return static_cast<std::size_t>(number);
}

}  // namespace palpate::fem
