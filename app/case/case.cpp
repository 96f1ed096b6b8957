// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "app/case/material.hpp"
#include "app/case/nearest.hpp"
#include "app/case/reader.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

std::string prefix(std::string_view section, std::size_t index) {
  return fmt::format("{}[{}].", section, index);
}

/// What the author left to the rest of the case: the name, the region of the only material.
void fill_defaults(Case& c, const std::string& file_name) {
  if (c.name.empty()) c.name = std::filesystem::path(file_name).stem().string();
  for (MaterialSection& material : c.materials) {
    if (material.region.empty()) material.region = c.surface.region;
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

/// Every region of the body, in the order of the case. @throws Error when one is named twice.
std::vector<std::string_view> regions_of(const Case& c, const SourceMap& sources) {
  std::vector<std::string_view> regions{c.surface.region};
  for (std::size_t i = 0; i < c.inclusions.size(); ++i) {
    const std::string& region = c.inclusions[i].region;
    if (std::find(regions.begin(), regions.end(), region) != regions.end()) {
      refuse(sources.where(prefix("inclusion", i) + "region"),
             fmt::format("region '{}' is named twice", region),
             "give each surface a region of its own");
    }
    regions.push_back(region);
  }
  return regions;
}

void check_materials(const Case& c, const SourceMap& sources) {
  const std::vector<std::string_view> regions = regions_of(c, sources);
  std::set<std::string_view> described;
  for (std::size_t i = 0; i < c.materials.size(); ++i) {
    const std::string& region = c.materials[i].region;
    const std::string where = sources.where(prefix("material", i) + "region");
    if (std::find(regions.begin(), regions.end(), region) == regions.end()) {
      refuse(where, fmt::format("material for region '{}', which no surface has", region),
             fmt::format("the nearest region is '{}'", nearest(region, regions)));
    }
    if (!described.insert(region).second) {
      refuse(where, fmt::format("second material for region '{}'", region),
             "remove one of the two");
    }
    fem::check_law(law_of(c.materials[i]), where);
  }
  for (const std::string_view region : regions) {
    if (described.contains(region)) continue;
    refuse(sources.where("material"), fmt::format("region '{}' has no material", region),
           fmt::format("add [[material]] with region = \"{}\"", region));
  }
}

/// Held depths that the case leaves open follow its depth.
void choose_depths(Case& c, const SourceMap& sources) {
  if (sources.has("indentation.lateral_depths")) return;
  const double depth = c.indentation.depth;
  c.indentation.lateral_depths = {depth / 3, 2 * depth / 3, depth};
}

void check_tool(const Case& c, const SourceMap& sources) {
  if (c.tool.edge_radius <= c.tool.radius) return;
  refuse(sources.where("tool.edge_radius"),
         fmt::format("tool.edge_radius = {} is larger than tool.radius = {}",
                     print_quantity(c.tool.edge_radius, Dimension::Length),
                     print_quantity(c.tool.radius, Dimension::Length)),
         "give at most the radius of the disc, or 0 for a sharp edge");
}

void check_depths(const Case& c, const SourceMap& sources) {
  for (const double held : c.indentation.lateral_depths) {
    if (held <= c.indentation.depth) continue;
    refuse(sources.where("indentation.lateral_depths"),
           fmt::format("indentation.lateral_depths holds {}, deeper than indentation.depth = {}",
                       print_quantity(held, Dimension::Length),
                       print_quantity(c.indentation.depth, Dimension::Length)),
           "keep every held depth within the depth");
  }
}

void check_supports(const Case& c, const SourceMap& sources) {
  for (std::size_t i = 0; i < c.supports.size(); ++i) {
    const SupportSection& support = c.supports[i];
    if (support.shape != "box") continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (support.low[axis] < support.high[axis]) continue;
      refuse(sources.where(prefix("support", i) + "low"),
             fmt::format("box support has low.{0} not below high.{0}", "xyz"[axis]),
             "give the corner with the smallest coordinates as low");
    }
  }
}

/// The gap to a flat end jumps at its edge: what is pressed there can neither slide off nor come
/// back.
void check_edge(const Case& c, const SourceMap& sources) {
  if (c.tool.shape != "disc" || c.tool.edge_radius > 0 || c.tool.friction == "no-slip") return;
  refuse(sources.where("tool.shape"), "a disc with a sharp edge cannot be pressed without friction",
         "give tool.edge_radius (a hundredth of the radius is enough), or friction = \"no-slip\"");
}

void check_sizes(const Case& c, const SourceMap& sources) {
  if (c.mesh.element_size <= c.mesh.patch_spacing) return;
  refuse(sources.where("mesh.element_size"),
         fmt::format("mesh.element_size = {} is larger than mesh.patch_spacing = {}",
                     print_quantity(c.mesh.element_size, Dimension::Length),
                     print_quantity(c.mesh.patch_spacing, Dimension::Length)),
         "the facets refine the response triangles: choose it at most as large");
}

Case parsed(const toml::table& table, const std::string& file_name) {
  SourceMap sources(file_name);
  Case c;
  TableReader reader(table, "the case", "", sources);
  describe(reader, c);
  reader.finish();
  fill_defaults(c, file_name);
  check_name(c, sources);
  check_materials(c, sources);
  choose_depths(c, sources);
  check_tool(c, sources);
  check_depths(c, sources);
  check_supports(c, sources);
  check_sizes(c, sources);
  check_edge(c, sources);
  return c;
}

}  // namespace

double& MaterialSection::constant(std::string_view name) {
  for (auto& [known, value] : constants) {
    if (known == name) return value;
  }
  return constants.emplace_back(name, 0.0).second;
}

Case parse_case(std::string_view toml, const std::string& file_name) {
  return parsed(parse_toml(toml, file_name), file_name);
}

Case read_case(const std::filesystem::path& path) {
  return parsed(read_toml(path, "the case file"), path.string());
}

}  // namespace palpate::app
