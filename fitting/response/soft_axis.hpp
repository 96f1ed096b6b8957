// SPDX-License-Identifier: AGPL-3.0-or-later
// The soft axis of a response: the lateral direction in which it is softer.
#pragma once

#include <array>
#include <vector>

#include "fitting/response/curve_fit.hpp"
#include "format/curves.hpp"
#include "format/vec3.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {

/// Longest soft axis that is fitted: along it friction is |b|^2 smaller.
inline constexpr double kMostFittedSoftAxis = 0.45;
/// A shorter soft axis is none: stiffnesses a hundredth apart are not felt.
inline constexpr double kLeastSoftAxis = 0.07;

/// S v = v - b (b . v) of a node with the soft axis b, for v across the press direction,
/// docs/theory-fitting.md (2f).
inline Vec3 stretched(const Vec3& soft_axis, const Vec3& v) {
  return v - dot(soft_axis, v) * soft_axis;
}

/// The soft axis b of a site by its drags. The symmetric stiffness K across the press direction is
/// the least-squares fit of the forces per displacement of all drags up to the shortest, over the
/// trace at each lateral depth; K is proportional to S^2. Zero where drags do not span the plane,
/// where K is not positive, and where b is shorter than kLeastSoftAxis; cut at kMostFittedSoftAxis.
/// @param inward  press direction of the site, unit
std::array<float, 3> fit_soft_axis(const SiteCurves& site, const Vec3& inward);

/// A lateral path along e of a response with a soft axis: its force is u w h(u d), u = |S e|.
struct SoftDrag {
  double stretch = 1;  ///< u
  std::vector<ForceSample> samples;
};
/// The lateral paths that have samples.
std::vector<SoftDrag> soft_drags(const SiteCurves& site, const Vec3& soft_axis);

/// What the samples would be along the direction in which u = 1, where f^r is the lateral response:
/// forces times f^r(d)/(u f^r(u d)), means times the quotient of what f^r stores meanwhile; both
/// over u^2 where f^r is straight.
std::vector<ForceSample> along_stiffest(const SoftDrag& drag,
                                        const runtime::CompiledCurve& lateral);
std::vector<std::vector<ForceSample>> along_stiffest(const std::vector<SoftDrag>& drags,
                                                     const runtime::CompiledCurve& lateral);

}  // namespace palpate::fitting
