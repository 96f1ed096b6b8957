// SPDX-License-Identifier: AGPL-3.0-or-later
// Constants of the regions of a body from indentation curves measured on it: least squares over the
// finite element model, with the gradients of fem/sensitivity.hpp.
#pragma once

#include <span>
#include <vector>

#include "app/calibrate/press_fit.hpp"
#include "fem/campaign/sensitivity.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// A constant to find; its start is the value in the settings of the campaign.
struct SoughtConstant {
  fem::RegionConstant constant;
  double low = 0, high = 0;  ///< Pa, or pure
};

struct InverseSettings : PressFitSettings {
  fem::CampaignSettings campaign;  ///< materials (starts), tool, tolerance, threads
  std::vector<SoughtConstant> sought;
};

/// fit_presses() with the finite element model of the body. Profiles cost one to three evaluations
/// an end where one constant is sought, up to some twenty where there are more; ends are found to a
/// hundredth of their distance.
/// Curves of one tool are those of the tool of the campaign. Several curves, of several tools, are
/// each pressed by their own: a small sphere shows how a law stiffens, a large one how stiff it is
/// at rest.
/// @throws Error(Configuration) for curves of another tool or shape, sites that are not of the
/// body, no measured normal path, constants of unknown regions; when the model fails at
///   the start.
PressFit calibrate_inverse(const Body& body, std::span<const Curves> measured,
                           const InverseSettings& settings);
PressFit calibrate_inverse(const Body& body, const Curves& measured,
                           const InverseSettings& settings);

}  // namespace palpate::app
