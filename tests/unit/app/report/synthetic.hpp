// SPDX-License-Identifier: AGPL-3.0-or-later
// Artifacts made from closed forms, for tests of what reads them: a lump with a stiff spot.
#pragma once

#include "format/body.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"
#include "format/recording.hpp"

namespace palpate::testing {

struct Synthetic {
  Body body;
  Curves curves;
  Library library;
  Recording recording;
};

/// The lump is a sphere of 40 mm with smooth bulges. Its response surface is an icosahedron split
/// `patches` times, its boundary that surface split `refinements` times more, its tetrahedra join
/// the facets to the centre. The lowest part is fixed.
///   f^z(d) = c(X) d^1.5, a Hertz contact whose factor c grows 2.5-fold over the stiff spot;
///   f^r(rho) = k(X) rho. The smallest det F falls to 0.5 at the end of the press. Tool work is the
///   exact integral; the strain energy is smaller by balance_gap(vertex).
/// One site failed (a hole), one is partial, one hole is filled. The session slides over the spot.
Synthetic synthetic(int patches, int refinements);

double hertz_factor(const Vec3& position);  ///< c, N/m^1.5
double balance_gap(std::int32_t vertex);    ///< (work - energy)/work of the normal path

inline constexpr double kDepth = 0.006;               ///< m
inline constexpr double kLeastVolumeChange = -36e-9;  ///< m^3, at kDepth; below it like d^2
inline constexpr std::int32_t kSamples = 12;

}  // namespace palpate::testing
