// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/settings.hpp"

#include <cmath>

#include "format/error.hpp"

namespace palpate::fem {

namespace {

void require_positive(const char* name, double value) {
  if (!(std::isfinite(value) && value > 0))
    refuse("indentation", std::string(name) + " = " + std::to_string(value) + " is out of range",
           std::string("give a finite ") + name + " > 0");
}

}  // namespace

ToolDescription description_of(const IndentationSettings& settings) {
  const ToolGeometry& tool = settings.tool;
  return {name_of(tool.shape), tool.radius, name_of(settings.friction), tool.edge_radius,
          tool.length};
}

void check_indentation(const IndentationSettings& settings) {
  check_tool(settings.tool);
  const ToolGeometry& tool = settings.tool;
  if (tool.shape == ToolShape::Disc && tool.edge_radius == 0 &&
      settings.friction == ToolFriction::Frictionless)
    refuse("tool", "a disc with a sharp edge cannot be pressed without friction",
           "give it an edge radius (a hundredth of its own is enough), or choose no-slip friction");
  if (settings.refine_under_tool == IndentationSettings::kByContact &&
      tool.shape == ToolShape::Disc && tool.edge_radius == 0)
    refuse("solver.refine_under_tool",
           "\"contact\" needs a size of the contact, which a disc with a sharp edge does not give",
           "give the disc an edge radius, or a number, which divides the elements as often");
  require_positive("size_over_contact", settings.size_over_contact);
  require_positive("depth", settings.depth);
  require_positive("force_tolerance", settings.force_tolerance);
  require_positive("increments", settings.increments);
  for (const double depth : settings.lateral_depths) {
    require_positive("lateral_depths", depth);
    if (depth > settings.depth * (1 + 1e-12))
      refuse("indentation", "a lateral depth of " + std::to_string(depth) + " m exceeds the depth",
             "keep lateral_depths at most " + std::to_string(settings.depth) + " m");
  }
  if (settings.lateral_depths.empty() || settings.azimuths.empty()) return;
  require_positive("lateral_travel", settings.lateral_travel);
  require_positive("lateral_increments", settings.lateral_increments);
}

}  // namespace palpate::fem
