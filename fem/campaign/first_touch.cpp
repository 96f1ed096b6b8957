// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/first_touch.hpp"

#include <cmath>

#include "fem/mesh/tangent_frame.hpp"
#include "fem/mesh/to_eigen.hpp"

namespace palpate::fem {

namespace {

/// The tool with its tip at the rest position of a point of the surface.
Tool tool_over(const CampaignContext& context, const PressPoint& point) {
  const IndentationSettings& settings = context.indentation;
  const Eigen::Vector3d inward = to_eigen(point.inward);
  const auto [first, second] = tangent_frame(inward);
  return {settings.tool, context.rest_position(point.position), inward,
          std::cos(settings.tool_azimuth) * first + std::sin(settings.tool_azimuth) * second};
}

}  // namespace

ToolContact contact_at(const CampaignContext& context, const QuadraticMesh& mesh,
                       const Eigen::Vector3d& X) {
  const IndentationSettings& settings = context.indentation;
  const double reach = settings.tool.extent() + settings.tool.radius + settings.lateral_travel;
  return {mesh, X, reach, context.contact_stiffness};
}

Tool tool_at_first_touch(const CampaignContext& context, const ToolContact& contact,
                         const Displacement& rest, const PressPoint& point) {
  Tool tool = tool_over(context, point);
  for (int i = 0; i < 60; ++i) {
    const double depth = contact.penetration_of(tool, rest);
    if (depth <= 1e-7 * tool.geometry.radius) break;
    tool.tip -= depth * tool.inward;
  }
  return tool;
}

FirstTouch first_touch(const CampaignContext& context, std::int32_t vertex) {
  const PressPoint point = context.press_point(vertex);
  const ToolContact contact =
      contact_at(context, context.model.mesh(), context.reference_position(point.position));
  return {tool_at_first_touch(context, contact, context.rest, point), contact.facets()};
}

}  // namespace palpate::fem
