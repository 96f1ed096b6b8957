// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/first_case.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/case/toml_string.hpp"
#include "app/console.hpp"
#include "app/init/facet_width.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

/// Six digits at most: "12.5 mm".
std::string mm(double metres) {
  const double value = 1e3 * metres;
  return fmt::format("{:.6g} mm", std::abs(value) < 1e-9 ? 0.0 : value);
}

/// In units of the file.
double raw_size(const BodyFile& body) {
  return mesher::largest_dimension(body.surface.points) / body.unit.si;
}

class Text {
 public:
  void section(std::string_view header) {
    if (!text_.empty()) text_ += '\n';
    text_ += fmt::format("{}\n", header);
  }
  void key(std::string_view name, const std::string& value, std::string_view why) {
    const std::string line = fmt::format("{} = {}", name, value);
    text_ += why.empty() ? line + '\n' : fmt::format("{:<30}  # {}\n", line, why);
  }
  void length(std::string_view name, double metres, std::string_view why) {
    key(name, toml_string(mm(metres)), why);
  }
  void line(std::string_view whole) { text_ += fmt::format("{}\n", whole); }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// The width of the facets of the surface of a file, m, where a tool feels them: half its radius or
/// more. 0 elsewhere.
double felt_facets(const BodyFile& body, const FirstSizes& sizes) {
  const double width = body.kind == BodyKind::Surface ? facet_width(body.surface) : 0;
  return width > 0.5 * sizes.tool_radius ? width : 0;
}

void write_source(Text& text, const BodyFile& body, const FirstSizes& sizes,
                  const std::string& file) {
  const bool states_unit = body.kind == BodyKind::Image && body.unit_source == UnitSource::Stated;
  const std::string unit(states_unit ? "header" : body.unit.symbol);
  text.section(body.kind == BodyKind::Surface ? "[surface]"
               : body.kind == BodyKind::Image ? "[image]"
                                              : "[volume_mesh]");
  text.key("file", toml_string(file), "relative to this case");
  text.key("unit", toml_string(unit), unit_reason(body, raw_size(body)));
  if (body.has_parts)
    text.key("parts", "\"largest\"", "the file has several; the others are left out");
  if (felt_facets(body, sizes) > 0)
    text.key("# smooth", "true", "takes the facets of the file for a smooth surface");
  for (const std::int32_t label : body.labels) {
    text.section("[[image_label]]");
    text.key("value", std::to_string(label), "remove the labels that are no part of the body");
    text.key("region", toml_string(fmt::format("label {}", label)), "a name for its material");
  }
}

void write_mesh(Text& text, const BodyFile& body, const FirstSizes& sizes) {
  const double area = sizes.pressable_area / body.area_excess;
  const std::string sites =
      sizes.sites ? std::to_string(*sizes.sites)
                  : fmt::format("some {:.0f}",
                                area / (kAreaOfVertex * sizes.patch_spacing * sizes.patch_spacing));
  text.section("[mesh]");
  text.length("patch_spacing", sizes.patch_spacing,
              fmt::format("{}{} sites on {} cm^2; {}",
                          sizes.is_thin       ? "smaller for a thin body: "
                          : sizes.is_coarsest ? "the largest that shows the shape: "
                                              : "",
                          sites, number_text(1e4 * area),
                          sizes.sites_too_slow
                              ? fmt::format("{} would take too long", *sizes.sites_too_slow)
                              : "halve it for up to four times as many"));
  text.length("element_size", sizes.element_size,
              body.kind == BodyKind::VolumeMesh ? "no effect: the mesh is used as it is"
              : sizes.refinement != Refinement::None
                  ? "smaller ones under the tool are made for each site"
                  : "half a patch; smaller is more accurate");
}

/// The point of the plane below the middle of the body, to 1e-4 of its extent.
Vec3 point_of(const Base& base, const mesher::Surface& surface) {
  const mesher::Bounds box = mesher::bounds(surface.points);
  const Vec3 middle = 0.5 * (box.low + box.high);
  Vec3 point = middle + (base.height - dot(base.down, middle)) * base.down;
  const double step =
      std::pow(10, std::floor(std::log10(1e-4 * mesher::largest_dimension(surface.points))));
  for (double& x : point) x = step * std::round(x / step);
  return point;
}

void write_support(Text& text, const Base& base, const mesher::Surface& surface) {
  const Vec3 point = point_of(base, surface);
  const auto rounded = [](double x) { return std::round(1e4 * x) / 1e4 + 0.0; };
  text.section("[[support]]");
  text.key("shape", "\"plane\"",
           fmt::format("{}, {:.0f} % of the surface",
                       base.is_flat ? "fixes the flat base" : "no flat base: fixes the lowest slab",
                       100 * base.fraction));
  text.key("point",
           fmt::format("[\"{}\", \"{}\", \"{}\"]", mm(point[0]), mm(point[1]), mm(point[2])),
           "what lies beyond is fixed");
  text.key("normal",
           fmt::format("[{:g}, {:g}, {:g}]", rounded(base.down[0]), rounded(base.down[1]),
                       rounded(base.down[2])),
           "down: a guess from the shape");
}

/// Constants of an entry of data/materials.toml.
void write_material(Text& text, const std::string& region) {
  text.section("[[material]]");
  if (!region.empty()) text.key("region", toml_string(region), "");
  text.key("law", "\"neo-hookean\"", "the simplest law of a soft solid");
  text.key("young", "\"6.9 kPa\"", "\"liver, human, elastography\" of data/materials.toml");
  text.key("poisson", "0.495", "nearly incompressible, as most soft tissue is");
}

std::string reason_of_depth(const FirstSizes& sizes) {
  std::string reason =
      fmt::format("the body is {} mm thick in the median, and {} mm in thin parts",
                  number_text(1e3 * sizes.thickness), number_text(1e3 * sizes.thin_parts));
  if (sizes.is_shallow)
    reason +=
        sizes.is_slow_where_thin ? "; deeper takes too long there" : "; deeper takes too long";
  return reason;
}

void write_refinement(Text& text, Refinement refinement) {
  switch (refinement) {
    case Refinement::ByContact:
      return text.key("refine_under_tool", "\"contact\"",
                      "elements under the tool as small as the contact asks for");
    case Refinement::Once:
      return text.key(
          "refine_under_tool", "true",
          "once; \"contact\" would make shallow forces more accurate, and takes too long");
    case Refinement::None:
      return text.line(
          "# refine_under_tool = \"contact\" would make the forces more accurate, and takes too "
          "long.");
  }
}

void write_paths(Text& text, const FirstSizes& sizes) {
  text.section("[tool]");
  text.length("radius", sizes.tool_radius, "a sphere that covers more than one element");
  text.key("friction", "\"no-slip\"", "the tool sticks, as friction lets it");
  text.section("[indentation]");
  text.length("depth", sizes.depth, reason_of_depth(sizes));
  text.length("lateral_travel", sizes.lateral_travel, "half the depth");
  text.key("lateral_depths",
           fmt::format("[\"{}\", \"{}\"]", mm(0.3 * sizes.depth), mm(0.8 * sizes.depth)),
           "two tell how the lateral response grows with depth");
  text.section("[solver]");
  write_refinement(text, sizes.refinement);
  text.key("mesh_error_sites", "4",
           "pressed on a finer mesh too: they bound the error of the mesh");
}

/// Names of the regions that need a material; one without a name is the default.
std::vector<std::string> regions_of(const BodyFile& body) {
  std::vector<std::string> regions = body.regions;
  for (const std::int32_t label : body.labels) regions.push_back(fmt::format("label {}", label));
  if (regions.empty()) regions.emplace_back();
  return regions;
}

std::vector<std::string> remarks_of(const BodyFile& body, const Base& base,
                                    const FirstSizes& sizes) {
  std::vector<std::string> remarks;
  remarks.push_back(fmt::format(
      "unit: {}, {}{}", body.unit.symbol, unit_reason(body, raw_size(body)),
      body.unit_source == UnitSource::Guessed ? "; if that is wrong, give --unit" : ""));
  remarks.push_back(
      fmt::format("support: {} towards ({:.2g}, {:.2g}, {:.2g})",
                  base.is_flat ? "the flat base" : "the lowest slab, no flat base found,",
                  base.down[0] + 0.0, base.down[1] + 0.0, base.down[2] + 0.0));
  if (body.was_repaired)
    remarks.push_back("the surface has faults that can be repaired: `palpate check` lists them");
  if (body.has_parts) remarks.emplace_back("the surface has several parts: the largest is taken");
  if (const double width = felt_facets(body, sizes); width > 0)
    remarks.push_back(fmt::format(
        "facets: the edges of the file are {} mm long, which the tool feels; if the body is smooth "
        "there, set smooth = true in [surface]",
        number_text(1e3 * width)));
  return remarks;
}

}  // namespace

std::string unit_reason(const BodyFile& body, double raw) {
  const auto length = [raw](const Unit& unit) { return number_text(1e3 * raw * unit.si) + " mm"; };
  const std::string size = fmt::format("the body is {} long", length(body.unit));
  if (body.unit_source == UnitSource::Given) return "as given: " + size;
  if (body.unit_source == UnitSource::Stated) return "stated by the file: " + size;
  std::string reason = "a GUESS from the size: " + size;
  if (body.other_unit)
    reason +=
        fmt::format(" ({} if the unit is {})", length(*body.other_unit), body.other_unit->symbol);
  return reason;
}

FirstCase first_case(const BodyFile& body, const Base& base, const FirstSizes& sizes,
                     const std::string& file, const std::string& name) {
  Text text;
  text.section("# A first case, by `palpate init`: change what you know better (docs/cases.md).");
  if (sizes.seconds)
    text.line(fmt::format("# Its campaign takes about {}, as trial sites on this machine tell.",
                          duration_text(*sizes.seconds)));
  if (!name.empty()) text.key("name", toml_string(name), "of the folder of its artifacts");
  write_source(text, body, sizes, file);
  write_mesh(text, body, sizes);
  write_support(text, base, body.surface);
  for (const std::string& region : regions_of(body)) write_material(text, region);
  write_paths(text, sizes);
  return {text.take(), remarks_of(body, base, sizes)};
}

}  // namespace palpate::app
