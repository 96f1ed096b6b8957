// SPDX-License-Identifier: AGPL-3.0-or-later
// Errors of the rendered skin against direct solutions. Definitions: docs/fidelity.md.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "fitting/fidelity/hold_out.hpp"
#include "fitting/fidelity/rendered_press.hpp"
#include "format/curves.hpp"
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

/// The skin pressed at the points, each state of each field: presses, and states of lateral paths
/// within and beyond friction. The vertices within three tool radii of the contact point, and all.
/// No rows of a kind without states. Sites that failed or are of no point, and lateral fields
/// without a press to their depth are left out.
/// @param fields  of a direct site, one at a time: they are large.
/// @throws Error(Configuration) where a field is of another body, or has no force.
std::vector<SkinErrorRow> measure_skin(const RenderedBody& body, const RenderedSkin& skin,
                                       const std::vector<HoldOutPoint>& points,
                                       const Curves& direct,
                                       const std::function<SiteFields(const SiteCurves&)>& fields,
                                       double friction);

}  // namespace palpate::fidelity
