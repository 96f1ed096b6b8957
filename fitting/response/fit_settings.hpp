// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <limits>

#include "format/library.hpp"

namespace palpate::fitting {

struct FitSettings {
  double relative_tolerance = 0.01;  ///< of the local force
  /// N; the larger of the two applies. NaN: kPeakFraction of the largest force of each curve, so
  /// that a soft site beside stiff ones is fitted as well as they are.
  double absolute_tolerance = std::numeric_limits<double>::quiet_NaN();
  int max_knots = 12;        ///< per curve
  bool fill_holes = false;   ///< Fill failed sites from their neighbours; status Interpolated.
  bool interpolate = false;  ///< Interpolate sites that were not computed; status Interpolated.
  /// Minimise the error in the mean over the triangles instead of at the nodes (between_nodes.hpp).
  bool between_nodes = false;
  bool lean = true;       ///< A straight press leans where its samples do (lean.hpp).
  bool soft_axes = true;  ///< Coupled responses are softer where drags are (soft_axis.hpp).
  ResponseKind kind = ResponseKind::Decoupled;
};

}  // namespace palpate::fitting
