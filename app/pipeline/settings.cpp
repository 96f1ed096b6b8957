// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/settings.hpp"

#include <variant>

#include "app/case/material.hpp"
#include "app/measured/sidecar.hpp"
#include "app/pipeline/device_profile.hpp"
#include "format/error.hpp"

namespace palpate::app {

namespace fs = std::filesystem;

namespace {

/// Paths of a case are relative to its file.
mesher::SurfaceFile resolved(const Workspace& space, mesher::SurfaceFile file) {
  file.path = space.case_folder / file.path;
  return file;
}

mesher::Zone resolved(const Workspace& space, mesher::Zone zone) {
  if (auto* plane = std::get_if<mesher::PlaneSupport>(&zone.shape))
    plane->normal = (1 / norm(plane->normal)) * plane->normal;
  if (auto* bone = std::get_if<mesher::SurfaceSupport>(&zone.shape))
    bone->surface = resolved(space, bone->surface);
  return zone;
}

void add_input(const Workspace& space, const mesher::Zone& zone, std::vector<fs::path>& inputs) {
  if (const auto* bone = std::get_if<mesher::SurfaceSupport>(&zone.shape))
    inputs.push_back(space.case_folder / bone->surface.path);
}

/// The file of the body, and those that belong to it: TetGen has several, a detached NRRD two.
void add_inputs(const fs::path& path, std::vector<fs::path>& inputs) {
  inputs.push_back(path);
  const fs::path kind = path.extension();
  std::vector<const char*> siblings;
  if (kind == ".node" || kind == ".ele") siblings = {".node", ".ele", ".face"};
  if (kind == ".nhdr") siblings = {".raw", ".raw.gz"};
  for (const char* sibling : siblings) {
    const fs::path other = fs::path(path).replace_extension(sibling);
    if (other != path && fs::exists(other)) inputs.push_back(other);
  }
}

/// Adaptive sampling judges fitted responses. Without fields nothing is said of
/// them.
std::string campaign_case(const Workspace& space) {
  std::string text =
      is_adaptive(space)
          ? resolved_sections(space.c, {"material", "tool", "indentation", "sampling", "solver",
                                        "gravity", "fit"})
          : resolved_sections(space.c, {"material", "tool", "indentation", "solver", "gravity"});
  const int depths = space.c.deformation.depths;
  if (depths > 0) text += "fields at " + std::to_string(depths) + " depths\n";
  return text;
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
  return space.c.sampling.method == SamplingMethod::Adaptive;
}

bool is_measured(const Workspace& space) {
  return !space.c.records.empty();
}

fs::path records_of(const Workspace& space) {
  return space.case_folder / space.c.records;
}

mesher::Settings mesh_settings(const Workspace& space) {
  const Case& c = space.c;
  mesher::Settings settings = c.mesh;
  settings.name = c.name;
  settings.surface = resolved(space, settings.surface);
  if (!settings.volume_mesh.path.empty())
    settings.volume_mesh.path = space.case_folder / settings.volume_mesh.path;
  if (!settings.image.path.empty()) settings.image.path = space.case_folder / settings.image.path;
  for (mesher::Zone& zone : settings.press) zone = resolved(space, zone);
  for (mesher::SurfaceFile& inclusion : settings.inclusions) inclusion = resolved(space, inclusion);
  for (mesher::Springs support : c.supports) {
    support.where = resolved(space, support.where);
    if (support.normal_stiffness > 0 || support.tangential_stiffness > 0) {
      settings.foundation.push_back(support);
    } else {
      settings.supports.push_back(support.where);
    }
  }
  if (c.sampling.method == SamplingMethod::Nodes) settings.patch_spacing = settings.element_size;
  settings.all_nodes_are_sites = c.sampling.method == SamplingMethod::Nodes;
  const fem::IndentationSettings& indentation = c.campaign.indentation;
  settings.tool_radius = indentation.tool.extent();
  settings.depth = indentation.depth;
  settings.lateral_travel = indentation.lateral_travel;
  return settings;
}

fem::CampaignSettings campaign_settings(const Workspace& space) {
  if (is_measured(space)) {
    refuse("case " + space.c.name, "nothing is known of the inside of a measured body",
           "finite elements need a case with [surface], [volume_mesh] or [image]");
  }
  fem::CampaignSettings settings = space.c.campaign;
  for (const MaterialSection& material : space.c.materials)
    settings.materials.push_back(campaign_material(material, space.case_folder));
  settings.threads = space.threads;
  settings.memory = space.memory;
  return settings;
}

SiteSharing sharing_of(const fem::CampaignSettings& settings) {
  // A tenth of the time of a site on refined elements is block solves.
  if (settings.indentation.refines()) return {static_cast<double>(settings.threads), 0.95, true};
  return {};
}

fitting::FitSettings fit_settings(const Workspace& space) {
  fitting::FitSettings settings = space.c.fit;
  settings.interpolate = is_adaptive(space);
  return settings;
}

fitting::CertifySettings certify_settings(const Workspace& space) {
  fitting::CertifySettings settings;
  settings.friction = space.c.certify.friction;
  const bool may_turn = space.c.mesh.directions == mesher::PressDirections::Normal;
  if (may_turn && !is_measured(space))
    settings.slide_remedy = "press_directions = \"sliding\" in [mesh]";
  for (const fs::path& file : stage_inputs(space, Stage::Certify)) {
    settings.devices.push_back(read_device_profile(file));
  }
  return settings;
}

void check_inputs(const Workspace& space, Stage last) {
  if (last >= Stage::Precompute && !is_measured(space)) campaign_settings(space);
  if (last >= Stage::Certify) certify_settings(space);
}

std::vector<fs::path> stage_inputs(const Workspace& space, Stage stage) {
  std::vector<fs::path> inputs;
  switch (stage) {
    case Stage::Mesh:
      if (is_measured(space)) return measured_files(records_of(space));
      add_inputs(space.case_folder / space.c.mesh.source(), inputs);
      for (const mesher::SurfaceFile& inclusion : space.c.mesh.inclusions)
        inputs.push_back(space.case_folder / inclusion.path);
      for (const mesher::Springs& support : space.c.supports)
        add_input(space, support.where, inputs);
      for (const mesher::Zone& zone : space.c.mesh.press) add_input(space, zone, inputs);
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
    case Stage::Mesh:  // with the tool and its depth: the mesher checks the thickness of the body
      return resolved_sections(space.c, {"", "measured", "surface", "volume_mesh", "mesh_region",
                                         "image", "image_label", "inclusion", "layer", "mesh",
                                         "support", "press", "tool", "indentation"}) +
             (space.c.sampling.method == SamplingMethod::Nodes ? "every surface node\n" : "");
    case Stage::Precompute:
      return campaign_case(space);
    case Stage::Fit:
      return resolved_sections(space.c, {"fit"}) + (is_adaptive(space) ? "interpolated\n" : "") +
             (space.c.deformation.depths > 0 ? resolved_sections(space.c, {"deformation"}) : "");
    case Stage::Certify:
      return resolved_sections(space.c, {"certify"});
  }
  return {};
}

}  // namespace palpate::app
