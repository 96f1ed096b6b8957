// SPDX-License-Identifier: AGPL-3.0-or-later
// What was measured at one site, as paths of a curve.
#pragma once

#include <string>
#include <vector>

#include "app/measured/sidecar.hpp"
#include "fitting/measurement/records/drag.hpp"
#include "fitting/measurement/records/press.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// Everything found at one site.
struct SiteRecords {
  int vertex = -1;
  Vec3 inward{};  ///< unit, along the presses
  std::vector<measured::PressCurve> presses;
  std::vector<measured::DragCurve> drags;
  std::string name;  ///< for messages; empty: that of the vertex
};

/// The mean press of a site, and its drags or the lateral path that is made for want of them.
/// @throws Error(Configuration) naming the site, as measured::mean_path; for several presses where
///   the sidecar wants samples as recorded.
SiteCurves site_curves(const SiteRecords& records, const Sidecar& sidecar);

}  // namespace palpate::app
