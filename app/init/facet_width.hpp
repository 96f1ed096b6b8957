// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "mesher/geometry/surface.hpp"

namespace palpate::app {

/// Median length, m, of the edges at which a surface bends, by a degree to the default
/// feature_angle: how wide the facets are that a tool feels. 0 for a body of flat faces.
/// @param surface  closed
double facet_width(const mesher::Surface& surface);

}  // namespace palpate::app
