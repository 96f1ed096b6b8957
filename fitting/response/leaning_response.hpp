// SPDX-License-Identifier: AGPL-3.0-or-later
// What a straight press feels where the response leans.
#pragma once

#include "fitting/response/soft_axis.hpp"
#include "format/library.hpp"
#include "format/vec3.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {

/// w of a node; no pieces, which is w = 1, where responses are decoupled.
runtime::CompiledCurve coupling_of(const NodeResponse& node, ResponseKind kind);

/// What the lean sigma of a node adds to its response, docs/theory-fitting.md (2d): a straight
/// press shears the tissue by w |sigma| for each depth, and the contact that grows meanwhile holds
/// tissue without stress. The runtime renders it with steps of any size; here they are
/// infinitesimal. With a soft axis p = S q is what the lateral response knows.
class LeaningResponse {
 public:
  LeaningResponse(const NodeResponse& node, ResponseKind kind);

  double energy(double z) const;        ///< work of the normal force below, J
  double normal_force(double z) const;  ///< w |S sigma| w h, N
  /// That of a straight press across its direction, N: -w h S S sigma/|S sigma|.
  Vec3 transverse_force(double z) const;
  /// By how much a drag d (m) at the depth z (m) along a unit direction across the press changes
  /// the force along it, N.
  double drag_force(double z, double d, const Vec3& direction) const;

 private:
  /// A straight press at a depth.
  struct Press {
    double lateral = 0;  ///< |p|, m
    double force = 0;    ///< w h, N
    double energy = 0;   ///< J
  };
  Press press(double z) const;
  double lateral_rate(double z, double lateral) const;
  runtime::CurveValue weight(double z) const;  ///< w, w'

  Vec3 stretch(const Vec3& v) const { return stretched(soft_axis_, v); }  ///< S v

  Vec3 soft_axis_{};
  Vec3 lean_{}, stretched_lean_{};  ///< sigma, S sigma
  double length_ = 0;               ///< |S sigma|
  runtime::CompiledCurve lateral_;
  runtime::CompiledCurve coupling_;  ///< no pieces: w = 1
};

}  // namespace palpate::fitting
