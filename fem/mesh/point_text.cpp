// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/point_text.hpp"

#include "format/position_text.hpp"

namespace palpate::fem {

std::string point_text(const Eigen::Vector3d& X) {
  return position_text({X[0], X[1], X[2]});
}

}  // namespace palpate::fem
