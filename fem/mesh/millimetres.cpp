// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/millimetres.hpp"

#include <cstdio>

#include "format/position_text.hpp"

namespace palpate::fem {

std::string in_millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f mm", 1e3 * metres);
  return text;
}

std::string point_text(const Eigen::Vector3d& X) {
  return position_text({X[0], X[1], X[2]});
}

}  // namespace palpate::fem
