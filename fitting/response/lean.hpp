// SPDX-License-Identifier: AGPL-3.0-or-later
// The lean of a response: how a straight press shears it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fitting/response/curve_fit.hpp"
#include "fitting/response/leaning_response.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"
#include "format/vec3.hpp"

namespace palpate::fitting {

/// Longest lean that is fitted, at any depth, in single precision below kMostLean.
inline constexpr double kMostFittedLean = 0.49;
/// A shorter lean is none: a force a thousandth off is not felt.
inline constexpr double kLeastLean = 1e-3;

/// The lean of a site by its drags: how the force along the press direction changes with the force
/// of a drag, docs/theory-fitting.md (2e). Least squares over the normal force of the lateral
/// depth. Absent where the drags do not span the plane across the press, or are too few to tell
/// what is proportional to the force of the drag from what is not.
std::optional<Vec3> lean_of_drags(const SiteCurves& site, const Vec3& inward,
                                  const NodeResponse& node, ResponseKind kind);

/// The tool of the straight presses of a campaign. One without friction shears nothing: its normal
/// force is g, and its transverse force tells nothing of the lean.
enum class PressingTool { Slips, Sticks };

/// The lean of a site: that of its drags; where the tool sticks, that which suits the transverse
/// force of its straight presses as well, as it grows from the first sample on, by the least
/// squares of the differences over the normal force. 0 where it is shorter than kLeastLean; cut at
/// kMostFittedLean.
/// @param inward  press direction of the site, unit. @param node  with its lateral response
std::array<float, 3> fit_lean(const SiteCurves& site, const Vec3& inward, const NodeResponse& node,
                              ResponseKind kind, PressingTool tool);

/// Normal samples of a tool that sticks less what the lean adds to them.
std::vector<ForceSample> less_lean(std::vector<ForceSample> samples, const LeaningResponse& lean);

}  // namespace palpate::fitting
