// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/fidelity_tables.hpp"

#include <fmt/format.h>

#include <iterator>

#include "format/number_text.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

using Json = nlohmann::ordered_json;

const char* press_name(PathKind kind) {
  return kind == PathKind::Normal ? "normal" : "oblique";
}

}  // namespace

std::string fidelity_text(const std::string& file, const fidelity::Fidelity& fidelity,
                          const LibrarySize& size) {
  std::string text = fmt::format("{}: {} bytes, {:.0f} bytes of curves a node\n", file, size.file,
                                 size.curves_per_node);
  text += fmt::format("  {:<40} {:<10} {:>6} {:>8} {:>8} {:>8}\n", "relative force error", "part",
                      "states", "median", "95 %", "worst");
  for (const fidelity::ErrorRow& row : fidelity.rows) {
    text += fmt::format("  {:<40} {:<10} {:>6} {:>6.2f} % {:>6.2f} % {:>6.2f} %\n", row.what,
                        row.part, row.states, 100 * row.median, 100 * row.p95, 100 * row.worst);
  }
  for (const std::string& line : fidelity.left_out) text += "  not complete: " + line + "\n";
  return text;
}

std::string fidelity_states_csv(const std::string& file, const fidelity::Fidelity& fidelity,
                                bool heading) {
  std::string csv;
  if (heading) {
    csv =
        "library,point,kind,depth_m,lateral_m,direct_x_N,direct_y_N,direct_z_N,rendered_x_N,"
        "rendered_y_N,rendered_z_N,scale_N,relative_error,within_friction\n";
  }
  for (const fidelity::ComparedState& s : fidelity.states) {
    fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", file,
                   s.point, press_name(s.kind), s.depth, s.lateral, s.direct[0], s.direct[1],
                   s.direct[2], s.rendered[0], s.rendered[1], s.rendered[2], s.scale, s.total(),
                   s.within_friction ? 1 : 0);
  }
  return csv;
}

std::string floor_text(const FidelityOptions& options, double floor) {
  std::string text = "errors are relative to the direct force, or to " + force_text(floor);
  if (!(options.floor > 0))
    text += " (" + percent_text(options.floor_fraction) + " of the median of the largest forces)";
  text += " where that is larger\n";
  if (options.finer_mesh)
    text += "the direct presses have a finer mesh: the error of the mesh of the case is counted\n";
  return text;
}

Json fidelity_heading(const FidelityOptions& options, const fidelity::FidelitySettings& settings,
                      const std::vector<fidelity::HoldOutPoint>& points) {
  Json list = Json::array();
  for (const fidelity::HoldOutPoint& p : points) {
    list.push_back({{"triangle", p.triangle},
                    {"natural", p.natural},
                    {"position_m", p.position},
                    {"inward", p.inward},
                    {"at_node", p.node},
                    {"skin_m", p.skin}});
  }
  Json heading{{"kind", "palpate.fidelity"}, {"relative_to", "max(|direct force|, floor)"},
               {"floor_N", settings.floor},  {"friction", settings.friction},
               {"seed", options.seed},       {"points", list}};
  heading["direct_mesh"] = options.finer_mesh ? "finer than that of the case" : "of the case";
  if (!(options.floor > 0)) heading["floor_fraction"] = options.floor_fraction;
  heading["libraries"] = Json::array();
  return heading;
}

Json fidelity_json(const std::filesystem::path& file, const fidelity::Fidelity& fidelity,
                   const LibrarySize& size) {
  Json rows = Json::array();
  for (const fidelity::ErrorRow& row : fidelity.rows) {
    rows.push_back({{"what", row.what},
                    {"part", row.part},
                    {"states", row.states},
                    {"median", row.median},
                    {"p95", row.p95},
                    {"worst", row.worst},
                    {"worst_N", row.worst_newton},
                    {"worst_point", row.worst_point}});
  }
  return {{"file", file.filename().string()},
          {"sha256", sha256_of_file(file)},
          {"bytes", size.file},
          {"curve_bytes_per_node", size.curves_per_node},
          {"rows", rows},
          {"left_out", fidelity.left_out}};
}

std::string skin_error_text(const std::vector<fidelity::SkinErrorRow>& rows) {
  if (rows.empty()) return {};
  std::string text = fmt::format("  {:<51} {:>6} {:>8} {:>8} {:>8}\n",
                                 "error of the skin, over the travel of the tip", "states",
                                 "median", "95 %", "worst");
  for (const fidelity::SkinErrorRow& row : rows)
    text += fmt::format("  {:<51} {:>6} {:>6.2f} % {:>6.2f} % {:>6.2f} %\n", row.what, row.states,
                        100 * row.median, 100 * row.p95, 100 * row.worst);
  return text;
}

Json skin_error_json(const std::vector<fidelity::SkinErrorRow>& rows) {
  Json list = Json::array();
  for (const fidelity::SkinErrorRow& row : rows)
    list.push_back({{"what", row.what},
                    {"states", row.states},
                    {"median", row.median},
                    {"p95", row.p95},
                    {"worst", row.worst},
                    {"worst_point", row.worst_point}});
  return list;
}

}  // namespace palpate::app
