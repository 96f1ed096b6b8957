// SPDX-License-Identifier: AGPL-3.0-or-later
// The certificate put to the proof: the force itself, rendered by the code of the runtime, searched
// for steeper places than the bounds allow.
#pragma once

#include <cstdint>

#include "format/library.hpp"

namespace palpate::fitting {

struct ChallengeSettings {
  int tries = 400;  ///< random presses of a triangle, held and sliding
  int climbs = 40;  ///< of the steepest of them, climbed further
  int steps = 400;  ///< of a climb
  unsigned seed = 1;
};

/// The steepest |df|/|dx| found, N/m, and where.
struct Steepest {
  double quotient = 0;
  double bound = 0;            ///< of the library: L_stick or L_slip
  std::int32_t triangle = -1;  ///< -1: nothing was found
  long tries = 0;
  double nearest = 0;  ///< largest quotient over the bound of its own triangle
};

struct ChallengeResult {
  Steepest held;     ///< with the contact point held, within the slip limit
  Steepest sliding;  ///< while the contact point slides inside a triangle
  /// No quotient exceeds the bound of its triangle, by more than the differences are good for.
  bool stands() const;
};

/// Draws contact points, depths with z + d0 <= D, lateral deflections up to the slip limit and
/// directions of the tool, and takes differences of the force over 0.1 micrometres; then climbs
/// from the steepest. Triangles without a finite slip bound are not slid on. Deterministic.
/// @throws Error(Configuration) when the library has no certificate.
ChallengeResult challenge(const Library& library, const ChallengeSettings& settings);

}  // namespace palpate::fitting
