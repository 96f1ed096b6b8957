// SPDX-License-Identifier: AGPL-3.0-or-later
// The lean of a response: how a straight press shears it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fitting/response/curve_fit.hpp"
#include "fitting/response/soft_axis.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"
#include "format/vec3.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {

/// Longest lean that is fitted, at any depth. Beyond it a press slips on most tissue, and bounds
/// grow.
inline constexpr double kMostFittedLean = 0.4;
/// A shorter lean is none: a force a thousandth off is not felt.
inline constexpr double kLeastLean = 1e-3;

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

/// The lean of a site by its drags: how the force along the press direction changes with the force
/// of a drag, docs/theory-fitting.md (2e). Least squares over the normal force of the lateral
/// depth. Absent where the drags do not span the plane across the press, or are too few to tell
/// what is proportional to the force of the drag from what is not.
std::optional<Vec3> lean_of_drags(const SiteCurves& site, const Vec3& inward,
                                  const NodeResponse& node, ResponseKind kind);

/// The tool of the straight presses of a campaign. One without friction shears nothing: its normal
/// force is g, and its transverse force tells nothing of the lean.
enum class PressingTool { Slips, Sticks };

/// The lean of a site: that of its drags; where these do not tell it and the tool sticks, the lean
/// that brings the transverse force of its straight presses closest to their samples, by the least
/// squares of the differences over the normal force, along the mean of the transverse forces. 0
/// where it is shorter than kLeastLean; cut at kMostFittedLean.
/// @param inward  press direction of the site, unit. @param node  with its lateral response
std::array<float, 3> fit_lean(const SiteCurves& site, const Vec3& inward, const NodeResponse& node,
                              ResponseKind kind, PressingTool tool);

/// Normal samples of a tool that sticks less what the lean adds to them.
std::vector<ForceSample> less_lean(std::vector<ForceSample> samples, const LeaningResponse& lean);

}  // namespace palpate::fitting
