// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/extrapolation.hpp"

namespace palpate::fem {

std::vector<double> extrapolation_weights(std::span<const double> s, double at) {
  std::vector<double> weights(s.size(), 1.0);
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = 0; j < s.size(); ++j)
      if (j != i) weights[i] *= (at - s[j]) / (s[i] - s[j]);
  return weights;
}

}  // namespace palpate::fem
