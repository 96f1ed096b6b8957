// SPDX-License-Identifier: AGPL-3.0-or-later
// Where a normal path begins.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fem/campaign/campaign_context.hpp"
#include "fem/campaign/site_body.hpp"
#include "fem/campaign/site_equilibrium.hpp"
#include "fem/contact/contact.hpp"

namespace palpate::fem {

/// The tool as it first touches a body without weight, and the facets it may meet, on the mesh that
/// the site presses: with the elements that the settings refine, whatever the engine.
struct FirstTouch {
  QuadraticMesh mesh;
  Tool tool;
  std::vector<Facet> facets;
};
FirstTouch first_touch(const CampaignContext& context, std::int32_t vertex);

/// The body around a point; a refined window has the elements that the settings ask for.
SiteBody site_body_at(const CampaignContext& context, const PressPoint& point, SiteMesh mesh);

/// The contact with the facets of `mesh` that the tool may reach from the point X on its paths.
ToolContact contact_at(const CampaignContext& context, const QuadraticMesh& mesh,
                       const Eigen::Vector3d& X);

/// The body of a site before the touch.
struct SiteAtRest {
  Displacement u;
  Eigen::Vector3d point;  ///< m, where the pressed point of the surface lies
  SolidModel::State state;
  std::string failure;  ///< why there is no equilibrium, one clause; else empty
};
/// Refined elements sag a little further under the weight than those of the campaign: the
/// equilibrium is found again. `contact`: that of the site; its tool is moved away.
SiteAtRest site_at_rest(const CampaignContext& context, const SiteBody& body, ToolContact contact,
                        SiteEquilibrium& equilibrium, const PressPoint& point);

/// The tool at first touch of a body with displacement `rest`: its tip at the point, which lies at
/// x, or drawn back along its direction where the surface is concave and the tool meets the body
/// before its tip does.
Tool tool_at_first_touch(const CampaignContext& context, const ToolContact& contact,
                         const Displacement& rest, const PressPoint& point,
                         const Eigen::Vector3d& x);

}  // namespace palpate::fem
