// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/laws/material.hpp"

#include <cmath>

#include "fem/laws/require.hpp"

namespace palpate::fem {

NeoHookean NeoHookean::from_young_poisson(double young, double poisson, const std::string& where) {
  require_constant(std::isfinite(young) && young > 0, where, "young (E, Pa)", young, "E > 0");
  require_constant(std::isfinite(poisson) && poisson >= 0 && poisson < 0.5, where, "poisson (nu)",
                   poisson, "0 <= nu < 0.5");
  return {young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))};
}

}  // namespace palpate::fem
