// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <variant>

#include "app/case/describe/case.hpp"
#include "app/case/lengths.hpp"
#include "app/case/nearest.hpp"
#include "app/case/reader.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

std::string exact_length_text(double metres) {
  return print_quantity(metres, Dimension::Length);
}

std::string prefix(std::string_view section, std::size_t index) {
  return fmt::format("{}[{}].", section, index);
}

/// Defaults that depend on other keys: the name, the regions of materials.
void fill_defaults(Case& c, const std::string& file_name) {
  if (c.name.empty()) c.name = std::filesystem::path(file_name).stem().string();
  for (MaterialSection& material : c.materials) {
    if (material.region.empty()) material.region = c.mesh.surface.region_name;
  }
}

void check_name(const Case& c, const SourceMap& sources) {
  const bool usable = std::all_of(c.name.begin(), c.name.end(), [](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-' || letter == '_';
  });
  if (usable) return;
  refuse(sources.where("name"), fmt::format("name = \"{}\" cannot name a folder", c.name),
         "give the case a name of letters, digits, '-' and '_'");
}

/// @throws Error for a void with a region, and for an inclusion with neither.
void check_region_of_inclusion(const mesher::SurfaceFile& inclusion, const std::string& where) {
  if (inclusion.is_void && !inclusion.region_name.empty()) {
    refuse(where, fmt::format("region '{}' of a void", inclusion.region_name),
           "remove region, or void");
  }
  if (!inclusion.is_void && inclusion.region_name.empty()) {
    refuse(where, "an inclusion without a region", "add region, or void = true");
  }
}

/// The tool and the paths of a measured body are in its sidecar, and it has no inside.
void check_measured(const SourceMap& sources) {
  for (const char* section :
       {"support", "material", "mesh", "press", "tool", "indentation", "sampling", "solver",
        "gravity", "deformation", "inclusion", "layer", "mesh_region", "image_label"}) {
    if (!sources.has(section)) continue;
    refuse(sources.where(section), fmt::format("[{}] with [measured]", section),
           "remove it: a measured body has no inside, and its tool is in the sidecar");
  }
}

/// Exactly one source of the body, and no section of another.
void check_source(const Case& c, const SourceMap& sources) {
  std::vector<std::string> given;
  for (const char* section : {"measured", "surface", "volume_mesh", "image"})
    if (sources.has(section)) given.emplace_back(section);
  if (given.size() > 1) {
    refuse(sources.where(given[1]), fmt::format("both [{}] and [{}] are given", given[0], given[1]),
           "remove one of the two");
  }
  if (given.empty()) {
    refuse(sources.where(""), "none of [surface], [volume_mesh], [image] and [measured] is given",
           "add [surface] with file and unit");
  }
  if (given[0] == "measured") return check_measured(sources);
  const auto belongs = [&](const char* list, bool is_empty, const char* section) {
    if (is_empty || given[0] == section) return;
    refuse(sources.where(list), fmt::format("[[{}]] with [{}]", list, given[0]),
           fmt::format("it belongs to [{}]: remove it", section));
  };
  belongs("inclusion", c.mesh.inclusions.empty(), "surface");
  belongs("layer", c.mesh.layers.empty(), "surface");
  belongs("mesh_region", c.mesh.volume_mesh.regions.empty(), "volume_mesh");
  belongs("image_label", c.mesh.image.labels.empty(), "image");
  if (given[0] == "image" && c.mesh.image.labels.empty()) {
    refuse(sources.where("image"), "[image] without [[image_label]]",
           "name the region of each label: value and region");
  }
}

/// @throws Error for a repeated label.
std::vector<std::string_view> regions_of_image(const Case& c, const SourceMap& sources) {
  std::vector<std::string_view> regions;
  std::set<int> values;
  for (std::size_t i = 0; i < c.mesh.image.labels.size(); ++i) {
    const auto& [value, region] = c.mesh.image.labels[i];
    if (!values.insert(value).second) {
      refuse(sources.where(prefix("image_label", i) + "value"),
             fmt::format("the label {} for the second time", value), "remove one of the two");
    }
    if (std::find(regions.begin(), regions.end(), region) == regions.end())
      regions.push_back(region);
  }
  return regions;
}

/// Every region of the body, in the order of the case. @throws Error for a repeated name.
std::vector<std::string_view> regions_of(const Case& c, const SourceMap& sources) {
  if (!c.mesh.image.path.empty()) return regions_of_image(c, sources);
  std::vector<std::string_view> regions{c.mesh.surface.region_name};
  const auto add = [&](const std::string& region, const std::string& where) {
    if (std::find(regions.begin(), regions.end(), region) != regions.end()) {
      refuse(where, fmt::format("two surfaces bound the region '{}'", region),
             "give each surface and layer a region of its own");
    }
    regions.push_back(region);
  };
  for (std::size_t i = 0; i < c.mesh.layers.size(); ++i)
    add(c.mesh.layers[i].region_name, sources.where(prefix("layer", i) + "region"));
  for (std::size_t i = 0; i < c.mesh.inclusions.size(); ++i) {
    const mesher::SurfaceFile& inclusion = c.mesh.inclusions[i];
    const std::string where = sources.where(prefix("inclusion", i) + "region");
    check_region_of_inclusion(inclusion, where);
    if (!inclusion.is_void) add(inclusion.region_name, where);
  }
  return regions;
}

/// The law as written, the series, and the instantaneous law that both make.
void check_material(const MaterialSection& material, const std::string& name,
                    const SourceMap& sources) {
  fem::check_law(material.law, sources.where(name + "region"));
  if (material.relaxation.empty()) {
    if (sources.has(name + "moduli"))
      refuse(sources.where(name + "moduli"), fmt::format("{}moduli without relaxation", name),
             "remove it: the moduli of elastic tissue are the same at all times");
    return;
  }
  const std::string where = sources.where(name + "relaxation");
  fem::check_law(fem::instantaneous_law(material.law, material.relaxation, material.moduli, where),
                 where);
}

void check_materials(const Case& c, const SourceMap& sources) {
  const std::vector<std::string_view> regions = regions_of(c, sources);
  // Those of a volume mesh are in its file: check_regions of the mesh stage compares them.
  const bool knows_regions = c.mesh.volume_mesh.path.empty();
  std::set<std::string_view> described;
  for (std::size_t i = 0; i < c.materials.size(); ++i) {
    const std::string& region = c.materials[i].region;
    const std::string where = sources.where(prefix("material", i) + "region");
    if (knows_regions && std::find(regions.begin(), regions.end(), region) == regions.end()) {
      refuse(where, fmt::format("material for region '{}', which no surface bounds", region),
             meant_instead(region, regions, "the nearest region"));
    }
    if (!described.insert(region).second) {
      refuse(where, fmt::format("second material for region '{}'", region),
             "remove one of the two");
    }
    check_material(c.materials[i], prefix("material", i), sources);
  }
  for (const std::string_view region : regions) {
    if (!knows_regions || described.contains(region)) continue;
    refuse(sources.where("material"), fmt::format("region '{}' has no material", region),
           fmt::format("add [[material]] with region = \"{}\"", region));
  }
}

/// A body that lies under its weight has relaxed, and the campaign has instantaneous laws.
void check_weight(const Case& c, const SourceMap& sources) {
  if (!c.campaign.gravity.acts()) return;
  for (std::size_t i = 0; i < c.materials.size(); ++i)
    if (!c.materials[i].relaxation.empty())
      refuse(sources.where(prefix("material", i) + "relaxation"),
             "relaxation of a body under its weight",
             "remove [gravity], or the relaxation: the preload of relaxed tissue is not modelled");
}

/// A disc without fillet has a discontinuous gap at its edge: frictionless contact does not
/// converge there.
void check_tool(const Case& c, const SourceMap& sources) {
  const fem::IndentationSettings& s = c.campaign.indentation;
  if (s.tool.edge_radius > s.tool.radius)
    refuse(sources.where("tool.edge_radius"),
           fmt::format("tool.edge_radius = {} is larger than tool.radius = {}",
                       exact_length_text(s.tool.edge_radius), exact_length_text(s.tool.radius)),
           "give at most the radius of the disc, or 0 for a sharp edge");
  if (s.tool.shape == fem::ToolShape::Disc && !(s.tool.edge_radius > 0) &&
      s.friction == fem::ToolFriction::Frictionless)
    refuse(
        sources.where("tool.shape"), "a disc with a sharp edge needs no-slip contact",
        "give tool.edge_radius (a hundredth of the radius is enough), or friction = \"no-slip\"");
}

void check_depths(const Case& c, const SourceMap& sources) {
  const fem::IndentationSettings& s = c.campaign.indentation;
  for (const double depth : s.lateral_depths) {
    if (!(depth > s.depth)) continue;
    refuse(sources.where("indentation.lateral_depths"),
           fmt::format("the lateral depth {} is larger than indentation.depth = {}",
                       exact_length_text(depth), exact_length_text(s.depth)),
           "give lateral depths of at most the depth");
  }
}

void check_box(const mesher::Zone& zone, const std::string& where) {
  const auto* box = std::get_if<mesher::BoxSupport>(&zone.shape);
  if (box == nullptr) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box->low[axis] < box->high[axis]) continue;
    refuse(where, fmt::format("box support has low.{0} not below high.{0}", "xyz"[axis]),
           "give the corner with the smallest coordinates as low");
  }
}

void check_zones(const Case& c, const SourceMap& sources) {
  for (std::size_t i = 0; i < c.supports.size(); ++i)
    check_box(c.supports[i].where, sources.where(prefix("support", i) + "low"));
  for (std::size_t i = 0; i < c.mesh.press.size(); ++i)
    check_box(c.mesh.press[i], sources.where(prefix("press", i) + "low"));
}

void check_sizes(const Case& c, const SourceMap& sources) {
  if (!(c.mesh.element_size > c.mesh.patch_spacing)) return;
  refuse(
      sources.where("mesh.element_size"),
      fmt::format("mesh.element_size = {} is larger than mesh.patch_spacing = {}",
                  exact_length_text(c.mesh.element_size), exact_length_text(c.mesh.patch_spacing)),
      "give at most the patch spacing: facets subdivide the response triangles");
}

Case parsed(const toml::table& table, const std::string& file_name, const SizeOfBody& size) {
  SourceMap sources(file_name);
  Case c;
  TableReader reader(table, "the case", "", sources);
  describe(reader, c);
  reader.finish();
  fill_defaults(c, file_name);
  check_name(c, sources);
  check_source(c, sources);
  if (!c.records.empty()) return c;
  check_materials(c, sources);
  check_weight(c, sources);
  std::optional<BodySize> body;
  if (size && needs_body_size(c)) body = size(c);
  derive_lengths(c, body);
  check_tool(c, sources);
  check_depths(c, sources);
  check_zones(c, sources);
  check_sizes(c, sources);
  return c;
}

}  // namespace

mesher::Settings mesh_of_case() {
  mesher::Settings settings;
  settings.patch_spacing = settings.element_size = kAuto;
  return settings;
}

fem::CampaignSettings campaign_of_case() {
  fem::CampaignSettings settings;
  fem::IndentationSettings& paths = settings.indentation;
  paths.tool.radius = paths.depth = paths.lateral_travel = kAuto;
  paths.lateral_depths.clear();
  paths.drag_across = true;
  return settings;
}

fitting::FitSettings fit_of_case() {
  fitting::FitSettings settings;
  settings.kind = ResponseKind::Coupled;
  return settings;
}

Case parse_case(std::string_view toml, const std::string& file_name, const SizeOfBody& size) {
  return parsed(parse_toml(toml, file_name), file_name, size);
}

Case read_case(const std::filesystem::path& path, const SizeOfBody& size) {
  return parsed(read_toml(path, "the case file"), path.string(), size);
}

}  // namespace palpate::app
