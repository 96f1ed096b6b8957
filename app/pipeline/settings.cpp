// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/settings.hpp"

#include <numbers>
#include <utility>

#include "app/case/material.hpp"
#include "app/case/quantity.hpp"
#include "app/pipeline/device_profile.hpp"

namespace palpate::app {

namespace fs = std::filesystem;

namespace {

double unit_length(const std::string& symbol) {
  return parse_quantity("1 " + symbol, Dimension::Length).value;
}

template <class Section>
mesher::SurfaceFile surface_file(const Workspace& space, const Section& section) {
  return {space.case_folder / section.file, unit_length(section.unit), section.region};
}

mesher::Support support_of(const Workspace& space, const SupportSection& section) {
  if (section.shape == "surface") {
    return mesher::SurfaceSupport{{space.case_folder / section.file, unit_length(section.unit), ""},
                                  section.distance};
  }
  if (section.shape == "plane") {
    return mesher::PlaneSupport{section.point, (1 / norm(section.normal)) * section.normal};
  }
  if (section.shape == "box") return mesher::BoxSupport{section.low, section.high};
  if (section.shape == "label") return mesher::LabelSupport{section.label};
  return mesher::SphereSupport{section.centre, section.radius};
}

fem::ToolGeometry tool_of(const ToolSection& section) {
  fem::ToolShape shape = fem::ToolShape::Sphere;
  if (section.shape == "disc") shape = fem::ToolShape::Disc;
  if (section.shape == "cylinder") shape = fem::ToolShape::Cylinder;
  return {shape, section.radius, section.edge_radius, section.length};
}

}  // namespace

std::string stage_name(Stage stage) {
  switch (stage) {
    case Stage::Mesh:
      return "mesh";
    case Stage::Precompute:
      return "precompute";
    case Stage::Fit:
      return "fit";
    case Stage::Certify:
      return "certify";
  }
  return {};
}

bool is_adaptive(const Workspace& space) {
  return space.c.sampling.method == "adaptive";
}

mesher::Settings mesh_settings(const Workspace& space) {
  const Case& c = space.c;
  mesher::Settings settings;
  settings.name = c.name;
  settings.surface = surface_file(space, c.surface);
  for (const auto& inclusion : c.inclusions) {
    settings.inclusions.push_back(surface_file(space, inclusion));
  }
  for (const auto& support : c.supports) {
    if (support.normal_stiffness > 0 || support.tangential_stiffness > 0) {
      settings.foundation.push_back(
          {support_of(space, support), support.normal_stiffness, support.tangential_stiffness});
    } else {
      settings.supports.push_back(support_of(space, support));
    }
  }
  const bool all_nodes = c.sampling.method == "nodes";
  settings.patch_spacing = all_nodes ? c.mesh.element_size : c.mesh.patch_spacing;
  settings.element_size = c.mesh.element_size;
  settings.interior_growth = c.mesh.interior_growth;
  settings.feature_angle = c.mesh.feature_angle * 180 / std::numbers::pi;
  settings.curved_facets = c.mesh.curved_facets;
  settings.tool_radius = tool_of(c.tool).extent();
  settings.depth = c.indentation.depth;
  settings.lateral_travel = c.indentation.lateral_travel;
  return settings;
}

fem::CampaignSettings campaign_settings(const Workspace& space) {
  const Case& c = space.c;
  fem::CampaignSettings settings;
  for (const MaterialSection& material : c.materials) {
    settings.materials.push_back({material.region, law_of(material, space.case_folder)});
  }
  if (c.solver.element == "tet10-displacement") settings.dilatation = fem::Dilatation::Pointwise;
  if (c.solver.element == "tet10-nodal-pressure") settings.dilatation = fem::Dilatation::Nodal;
  if (c.solver.element == "tet4") settings.dilatation = fem::Dilatation::LinearNodal;
  settings.gravity = {c.gravity.acceleration, c.gravity.density};
  fem::IndentationSettings& indentation = settings.indentation;
  indentation.tool = tool_of(c.tool);
  indentation.tool_azimuth = c.tool.azimuth;
  if (c.tool.friction == "no-slip") indentation.friction = fem::ToolFriction::NoSlip;
  indentation.depth = c.indentation.depth;
  indentation.increments = c.indentation.increments;
  indentation.lateral_travel = c.indentation.lateral_travel;
  indentation.lateral_increments = c.indentation.lateral_increments;
  indentation.lateral_depths = c.indentation.lateral_depths;
  indentation.azimuths = c.indentation.azimuths;
  indentation.force_tolerance = c.indentation.force_tolerance;
  indentation.refine_under_tool = c.solver.refine_under_tool;
  settings.threads = space.threads;
  settings.memory = space.memory;
  return settings;
}

fitting::FitSettings fit_settings(const Workspace& space) {
  const FitSection& fit = space.c.fit;
  fitting::FitSettings settings;
  settings.relative_tolerance = fit.relative_tolerance;
  settings.absolute_tolerance = fit.absolute_tolerance;
  settings.max_knots = fit.max_knots;
  settings.fill_holes = fit.fill_holes;
  settings.interpolate = is_adaptive(space);
  settings.between_nodes = fit.between_nodes;
  settings.kind = fit.responses == "coupled" ? ResponseKind::Coupled : ResponseKind::Decoupled;
  return settings;
}

fitting::CertifySettings certify_settings(const Workspace& space) {
  fitting::CertifySettings settings;
  settings.friction = space.c.certify.friction;
  for (const fs::path& file : stage_inputs(space, Stage::Certify)) {
    settings.devices.push_back(read_device_profile(file));
  }
  return settings;
}

std::vector<fs::path> stage_inputs(const Workspace& space, Stage stage) {
  std::vector<fs::path> inputs;
  switch (stage) {
    case Stage::Mesh:
      inputs.push_back(space.case_folder / space.c.surface.file);
      for (const auto& inclusion : space.c.inclusions) {
        inputs.push_back(space.case_folder / inclusion.file);
      }
      for (const auto& support : space.c.supports) {
        if (support.shape == "surface") inputs.push_back(space.case_folder / support.file);
      }
      break;
    case Stage::Precompute:
      inputs = {space.body()};
      for (const MaterialSection& material : space.c.materials) {
        if (reads_fibre_file(material)) inputs.push_back(space.case_folder / material.fibre_file);
      }
      break;
    case Stage::Fit:
      inputs = {space.body(), space.curves()};
      break;
    case Stage::Certify:
      for (const std::string& device : space.c.certify.devices) {
        inputs.push_back(space.case_folder / device);
      }
      break;
  }
  return inputs;
}

std::string stage_case(const Workspace& space, Stage stage) {
  switch (stage) {
    case Stage::Mesh:  // the tool and its depth: the mesher checks that the body is thick enough
      return resolved_sections(
                 space.c, {"", "surface", "inclusion", "mesh", "support", "tool", "indentation"}) +
             (space.c.sampling.method == "nodes" ? "every surface node\n" : "");
    case Stage::Precompute:  // adaptive sampling judges what is fitted
      return is_adaptive(space)
                 ? resolved_sections(space.c, {"material", "tool", "indentation", "sampling",
                                               "solver", "gravity", "fit"})
                 : resolved_sections(space.c,
                                     {"material", "tool", "indentation", "solver", "gravity"});
    case Stage::Fit:
      return resolved_sections(space.c, {"fit"}) + (is_adaptive(space) ? "interpolated\n" : "");
    case Stage::Certify:
      return resolved_sections(space.c, {"certify"});
  }
  return {};
}

}  // namespace palpate::app
