// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/millimetres.hpp"

#include <cstdio>

namespace palpate::fem {

std::string in_millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f mm", 1e3 * metres);
  return text;
}

std::string point_in_millimetres(const Eigen::Vector3d& X) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.1f, %.1f, %.1f) mm", 1e3 * X[0], 1e3 * X[1], 1e3 * X[2]);
  return text;
}

}  // namespace palpate::fem
