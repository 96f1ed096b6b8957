// SPDX-License-Identifier: AGPL-3.0-or-later
// The lengths that a case leaves to be derived: each follows from another one, the first from the
// size of the body, so that a case without lengths suits bodies of every size.
#pragma once

#include "app/case/case.hpp"

namespace palpate::app {

inline constexpr double kElementOverPatch = 0.5;
inline constexpr double kRadiusOverPatch = 0.65;  ///< a tool that covers more than one element
inline constexpr double kDepthOverPatch = 0.4;    ///< the contact stays smaller than the tool
inline constexpr double kTravelOverDepth = 0.5;

/// Whether a length of the case is to be derived from the size of its body.
bool needs_body_size(const Case& c);

/// Gives every length that is `auto` its value, as docs/cases.md states. Without a size, lengths
/// that depend on it stay `auto`.
void derive_lengths(Case& c, const std::optional<BodySize>& body);

}  // namespace palpate::app
