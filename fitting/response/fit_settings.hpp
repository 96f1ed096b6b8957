// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "format/library.hpp"

namespace palpate::fitting {

struct FitSettings {
  double relative_tolerance = 0.01;   ///< of the local force
  double absolute_tolerance = 0.005;  ///< N; the larger of the two applies
  int max_knots = 12;                 ///< per curve
  bool fill_holes = false;   ///< Fill failed sites from their neighbours; status Interpolated.
  bool interpolate = false;  ///< Interpolate sites that were not computed; status Interpolated.
  /// Minimise the error in the mean over the triangles instead of at the nodes (between_nodes.hpp).
  bool between_nodes = false;
  ResponseKind kind = ResponseKind::Decoupled;
};

}  // namespace palpate::fitting
