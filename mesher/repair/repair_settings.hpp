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
  double max_change = 0.01;  ///< largest distance that the surface of the file may move
  double max_hole = 0.3;     ///< largest diameter of a hole that is filled, unless it is flat
  double negligible_part =
      0.05;  ///< separate parts with a smaller extent are removed, and those of little area
  bool largest_part = false;  ///< of several parts keep the one of the largest area
};

}  // namespace palpate::mesher
