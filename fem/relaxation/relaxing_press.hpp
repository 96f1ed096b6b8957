// SPDX-License-Identifier: AGPL-3.0-or-later
// One site of a body that relaxes, under a tool that moves as prescribed: the reference for the
// quasi-linear responses of the library.
#pragma once

#include <string>
#include <vector>

#include "fem/campaign/settings.hpp"
#include "format/body.hpp"

namespace palpate::fem {

/// Where the tool is at a time. Between two of them it moves at a constant speed; two at the same
/// time are a step.
struct ToolMotion {
  double time_s = 0;
  double travel = 0;  ///< m, from first touch along the press direction; negative: above it
  double drag = 0;    ///< m, across it along azimuth 0 of the campaign
};

struct RelaxingSettings {
  /// Largest error of the force in one time step, over the largest force so far; of a tool that
  /// sticks, over the force in proportion at the largest travel if that is larger.
  double time_tolerance = 1e-3;
  int max_steps = 2000;  ///< of time, those that are repeated included
};

struct RelaxingSample {
  double time_s = 0;
  double travel = 0;        ///< m
  double drag = 0;          ///< m
  Vec3 force{};             ///< N, of the tool ON the body
  double contact_area = 0;  ///< m^2, reference
  double penetration = 0;   ///< m, deepest violation of the contact constraint
  double time_error = 0;    ///< N, estimate for the time step that ends here
};

struct RelaxingPress {
  std::vector<RelaxingSample> samples;  ///< at the end of every time step, the start included
  bool complete = false;
  std::string reason;  ///< why the motion was not followed to its end; else empty
};

/// Follows the motion with Newton's method on the whole body, as Engine::Direct. The materials of
/// the settings have their instantaneous laws and their relaxation. Each time step is solved at
/// once and in two halves; a third of the difference of the forces is its error, and the halves are
/// kept. Tool steps are at most one increment of the settings. Where a drag begins, the surface in
/// contact is bonded to the tool, as in the lateral paths of a campaign. Contact of the body with
/// itself and loss of ellipticity are not looked for. One thread.
/// @param vertex  response vertex, or index of a point of the settings.
/// @throws Error(Configuration) for a motion that is empty, does not start at 0 s, a travel of at
/// most 0 and no drag, goes back in time or is not finite, as run_campaign for the settings, for
/// gravity or refinement under the tool, and for a time tolerance below twice the force_tolerance.
RelaxingPress press_relaxing(const Body& body, const CampaignSettings& settings,
                             std::int32_t vertex, const std::vector<ToolMotion>& motion,
                             const RelaxingSettings& relaxing = {});

}  // namespace palpate::fem
