// SPDX-License-Identifier: AGPL-3.0-or-later
// Search for a counterexample to a certificate: difference quotients of the force, as the runtime
// renders it, that exceed the bounds.
#pragma once

#include <cstdint>

#include "format/library.hpp"

namespace palpate::fitting {

struct ChallengeSettings {
  int tries = 400;  ///< random states of each triangle, at a fixed contact point and sliding
  int climbs = 40;  ///< number of the steepest of them that are starting points of a hill climb
  int steps = 400;  ///< of each hill climb
  unsigned seed = 1;
};

/// The largest |df|/|dx| found.
struct Steepest {
  double quotient = 0;         ///< N/m
  double bound = 0;            ///< of the library, N/m: L_stick or L_slip
  std::int32_t triangle = -1;  ///< -1: nothing was found
  long tries = 0;
  double max_ratio = 0;  ///< largest quotient over the bound of its own triangle
};

struct ChallengeResult {
  Steepest sticking;  ///< at a fixed contact point, within the slip limit
  Steepest sliding;   ///< while the contact point slides inside a triangle
  /// Whether no quotient exceeds the bound of its triangle by more than the error of differences.
  bool confirms() const;
};

/// Draws contact points, depths with z + d0 <= D, lateral deflections up to the slip limit and
/// directions of the tool, and takes differences of the force over 0.1 micrometres. Hill climbs
/// start from the steepest. Triangles without a finite slip bound are skipped. Deterministic.
/// @throws Error(Configuration) when the library has no certificate.
ChallengeResult challenge(const Library& library, const ChallengeSettings& settings);

}  // namespace palpate::fitting
