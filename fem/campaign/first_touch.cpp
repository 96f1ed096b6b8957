// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/first_touch.hpp"

#include <cmath>

#include "fem/mesh/tangent_frame.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/solve/preload.hpp"
#include "fem/solve/profile.hpp"

namespace palpate::fem {

namespace {

/// The tool that presses a point of the surface, with its tip at `tip`.
Tool tool_with_tip(const CampaignContext& context, const PressPoint& point,
                   const Eigen::Vector3d& tip) {
  const IndentationSettings& settings = context.indentation;
  const Eigen::Vector3d inward = to_eigen(point.inward);
  const auto [first, second] = tangent_frame(inward);
  return {settings.tool, tip, inward,
          std::cos(settings.tool_azimuth) * first + std::sin(settings.tool_azimuth) * second};
}

/// Size of elements that the contact divides, over that of the coarser mesh: smaller ones cost more
/// than the campaign of a small body.
constexpr double kFinerByContact = 0.7;
/// Depth at which the grading begins, over that of the first increment: the elements inside of its
/// contact are then smaller than those at its edge, as they are inside of later contacts.
constexpr double kFirstDepth = 0.5;
/// Growth of elements with the distance from the last contact: those of the body are reached soon.
/// Where they are larger than the contact, slower growth costs as much as smaller elements under
/// it, and helps less.
constexpr double kGrowthOutside = 10;
/// Distance of a tool that is not there, over the extent of the body.
constexpr double kFarAway = 10;

SiteRefinement refinement_of(const CampaignContext& context, const PressPoint& point) {
  const IndentationSettings& settings = context.indentation;
  SiteRefinement refinement;
  const bool by_contact = settings.refine_under_tool == IndentationSettings::kByContact;
  refinement.levels = by_contact ? 0 : settings.refine_under_tool;
  if (settings.divide_once_more) {
    refinement.first_levels = refinement.levels > 0 ? 2 : 1;
    ++refinement.levels;
  }
  if (!(by_contact || settings.divide_once_more)) return refinement;
  refinement.cores =
      contact_cores(context.model.mesh(),
                    tool_with_tip(context, point, context.reference_position(point.position)),
                    kFirstDepth * settings.depth / settings.increments, settings.depth);
  const double finer = by_contact && settings.divide_once_more ? kFinerByContact : 1;
  refinement.size_over_distance = finer * settings.size_over_contact;
  refinement.growth_outside = kGrowthOutside;
  return refinement;
}

/// Whether the body of a site sags further than that of the campaign.
bool sags_further(const CampaignContext& context, const SiteBody& body) {
  return body.prolongation() != nullptr && context.model.weight_norm() > 0;
}

}  // namespace

ToolContact contact_at(const CampaignContext& context, const QuadraticMesh& mesh,
                       const Eigen::Vector3d& X) {
  const IndentationSettings& settings = context.indentation;
  const double reach = settings.tool.extent() + settings.tool.radius + settings.lateral_travel;
  return {mesh, X, reach, context.contact_stiffness};
}

SiteAtRest site_at_rest(const CampaignContext& context, const SiteBody& body, ToolContact contact,
                        SiteEquilibrium& equilibrium, const PressPoint& point) {
  SiteAtRest rest{body.rest(), context.rest_position(point.position), {}, {}};
  if (sags_further(context, body)) {
    const QuadraticMesh& mesh = body.mesh();
    const double extent = (mesh.X.rowwise().maxCoeff() - mesh.X.rowwise().minCoeff()).norm();
    contact.move_to(
        tool_with_tip(context, point, rest.point - kFarAway * extent * to_eigen(point.inward)));
    rest.failure = equilibrium.settle(contact, rest.u).reason;
    const Eigen::Vector3d X = context.reference_position(point.position);
    rest.point = X + displacement_at(mesh, rest.u, X);
  }
  rest.state = body.whole().energy(rest.u);
  return rest;
}

Tool tool_at_first_touch(const CampaignContext& context, const ToolContact& contact,
                         const Displacement& rest, const PressPoint& point,
                         const Eigen::Vector3d& x) {
  Tool tool = tool_with_tip(context, point, x);
  for (int i = 0; i < 60; ++i) {
    const double depth = contact.penetration_of(tool, rest);
    if (depth <= 1e-7 * tool.geometry.radius) break;
    tool.tip -= depth * tool.inward;
  }
  return tool;
}

FirstTouch first_touch(const CampaignContext& context, std::int32_t vertex) {
  const PressPoint point = context.press_point(vertex);
  const Eigen::Vector3d X = context.reference_position(point.position);
  const bool refined = context.indentation.refines();
  const SiteBody body =
      site_body_at(context, point, refined ? SiteMesh::RefinedWindow : SiteMesh::WholeBody);
  const ToolContact contact = contact_at(context, body.mesh(), X);
  return {body.mesh(),
          tool_at_first_touch(context, contact, body.rest(), point,
                              context.rest_position(point.position)),
          contact.facets()};
}

SiteBody site_body_at(const CampaignContext& context, const PressPoint& point, SiteMesh mesh) {
  const PartTimer timer(Part::SiteMesh);
  const SiteRefinement refinement =
      mesh == SiteMesh::RefinedWindow ? refinement_of(context, point) : SiteRefinement{};
  return {context.model,
          context.rest,
          context.reference_position(point.position),
          context.indentation.tool,
          mesh,
          refinement};
}

}  // namespace palpate::fem
