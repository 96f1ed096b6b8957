// SPDX-License-Identifier: AGPL-3.0-or-later
// Where a normal path begins.
#pragma once

#include <cstdint>
#include <vector>

#include "fem/campaign/campaign_context.hpp"
#include "fem/campaign/site_body.hpp"
#include "fem/contact/contact.hpp"

namespace palpate::fem {

/// The tool as it first touches the body, and the facets it may meet, on the mesh that the site
/// presses: with the elements that the settings refine, whatever the engine.
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

/// The tool at first touch of a body with displacement `rest`: its tip at the point, or drawn back
/// along its direction where the surface is concave and the tool meets the body before its tip
/// does.
Tool tool_at_first_touch(const CampaignContext& context, const ToolContact& contact,
                         const Displacement& rest, const PressPoint& point);

}  // namespace palpate::fem
