// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/neighbours.hpp"

namespace palpate::fitting {

std::vector<std::set<std::size_t>> neighbours_of(const Library& library) {
  std::vector<std::set<std::size_t>> neighbours(library.positions.size());
  for (const Triangle& triangle : library.triangles) {
    for (const std::int32_t a : triangle) {
      for (const std::int32_t b : triangle) {
        if (a != b) neighbours[static_cast<std::size_t>(a)].insert(static_cast<std::size_t>(b));
      }
    }
  }
  return neighbours;
}

}  // namespace palpate::fitting
