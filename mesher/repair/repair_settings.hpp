// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace palpate::mesher {

enum class RepairMode {
  Auto,  ///< repair a surface that has faults, leave a sound one as it is to the last bit
  None,  ///< refuse a surface that has faults
  Wrap   ///< replace the surface by an alpha wrap
};

/// Lengths are fractions of the largest dimension of the surface.
struct RepairSettings {
  RepairMode mode = RepairMode::Auto;
  /// Largest distance that local repairs may move the surface; beyond, its alpha wrap replaces it.
  double max_change = 0.01;
  /// Larger holes are filled with a warning, unless they are flat cuts.
  double max_hole = 0.3;
  /// Separate parts with a smaller extent are removed, and those of little area.
  double negligible_part = 0.05;
  bool largest_part = false;  ///< of several parts keep the one of the largest area
};

}  // namespace palpate::mesher
