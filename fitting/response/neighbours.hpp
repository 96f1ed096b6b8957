// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "format/library.hpp"

namespace palpate::fitting {

/// For each vertex, the vertices with which it has a triangle in common.
std::vector<std::set<std::size_t>> neighbours_of(const Library& library);

}  // namespace palpate::fitting
