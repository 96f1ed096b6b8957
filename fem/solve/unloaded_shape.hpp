// SPDX-License-Identifier: AGPL-3.0-or-later
// The shape without weight of a body whose shape under its weight is known.
#pragma once

#include <string>
#include <vector>

#include "fem/laws/law.hpp"
#include "fem/solid/solid_model.hpp"
#include "fem/solve/preload.hpp"
#include "format/body.hpp"

namespace palpate::fem {

/// A body without weight, and its equilibrium with it.
struct UnloadedBody {
  /// The given body with other positions of its nodes. Mid-edge nodes of the boundary lie where
  /// their displacement takes them to the given surface.
  Body body;
  SolidModel model;  ///< with the whole weight
  Displacement u;    ///< from the unloaded to the given shape
  double distance;   ///< m, the largest of a corner node from its given position
  int iterations;    ///< equilibria that were computed
};

/// Finds positions X of the corner nodes with X + u(X) = x, x the given ones and u(X) the
/// equilibrium under the weight of the body X: the fixed-point iteration X <- x - u(X) [Sellier
/// 2011] with Anderson's acceleration [Walker & Ni 2011]. The weight is applied in parts where the
/// whole does not converge. Then |X + u - x| is at most 1e-6 of the largest displacement. `laws`:
/// of the regions; their fibre directions are those of the given shape, a, and the body X has a_0
/// along F^-1 a, with F that of the linear tetrahedra. `permutation`: elimination order of a model
/// of the body.
/// @throws Error(Geometry) where no such body is found, with the fraction of the weight and why.
UnloadedBody find_unloaded_body(const Body& given, const std::vector<Law>& laws,
                                Dilatation dilatation, const Gravity& gravity,
                                const std::vector<int>& permutation,
                                const PreloadOptions& options = {});

}  // namespace palpate::fem
