// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace palpate::fem {

/// Where the volumetric energy of an element is taken.
enum class Dilatation {
  Mean,      ///< at the mean dilatation: an element-constant pressure
  Pointwise  ///< at every Gauss point: the pure displacement element, which locks near nu = 1/2
};

}  // namespace palpate::fem
