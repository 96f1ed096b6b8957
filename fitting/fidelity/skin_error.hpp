// SPDX-License-Identifier: AGPL-3.0-or-later
// Errors of the rendered skin against direct solutions. Definitions: docs/fidelity.md.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fitting/fidelity/hold_out.hpp"
#include "fitting/fidelity/rendered_press.hpp"
#include "format/site_fields.hpp"

namespace palpate::fidelity {

/// Distribution, over vertices and states, of |rendered - direct displacement| over the length that
/// the tip has moved from the contact point. Nearest rank.
struct SkinErrorRow {
  std::string what;  ///< "press, within 3 tool radii", ...
  std::size_t states = 0;
  double median = 0, p95 = 0, worst = 0;
  std::size_t worst_point = 0;
};

/// The skin pressed at the points, each state of each field: presses and the ends of lateral paths.
/// The vertices within three tool radii of the contact point, and all. Fields without a point, by
/// SiteFields::vertex, and lateral fields without a press to their depth are left out.
std::vector<SkinErrorRow> measure_skin(const RenderedBody& body, const RenderedSkin& skin,
                                       const std::vector<HoldOutPoint>& points,
                                       const std::vector<SiteFields>& direct, double tool_radius);

}  // namespace palpate::fidelity
