// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/contact_element.hpp"

#include <algorithm>

namespace palpate::fitting {

std::vector<double> ContactElement::depth_cells() const {
  std::vector<double> ends = normal.cells({0, depth}, 1);
  if (!coupling) return ends;
  const std::vector<double> more = coupling->cells({0, depth}, 1);
  ends.insert(ends.end(), more.begin(), more.end());
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

}  // namespace palpate::fitting
