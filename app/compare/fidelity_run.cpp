// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/fidelity_run.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <system_error>

#include "app/compare/fidelity_tables.hpp"
#include "app/console.hpp"
#include "app/pipeline/events.hpp"
#include "app/pipeline/fields.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "fitting/fidelity/skin.hpp"
#include "fitting/fidelity/skin_error.hpp"
#include "fitting/response/response_surface.hpp"
#include "format/crash_safe_file.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/sha256.hpp"
#include "format/site_journal.hpp"
#include "palpate_version.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

/// Lateral depths over the depth of the case, between the usual depths of a campaign.
constexpr double kLateralDepths[] = {0.2, 0.6, 0.9};
constexpr double kAzimuths[] = {50, 185};  // degrees; unusual in campaigns
constexpr int kMinIncrements = 6;
/// A press that sticks takes as many increments or more: what touches during one slides until its
/// end.
constexpr int kStickingIncrements = 24;
constexpr double kSameDepth = 1e-6;  // over the depth of the case

fs::path direct_fields(const Workspace& space) {
  return space.out / "fidelity-fields";
}

/// Direct solutions: the paths of the case, at additional depths and other directions. The tool
/// sticks, as its friction lets it.
fem::CampaignSettings direct_settings(const Workspace& space, bool finer_mesh,
                                      const std::vector<fidelity::HoldOutPoint>& points) {
  fem::CampaignSettings settings = campaign_settings(space);
  settings.indentation.divide_once_more = finer_mesh;
  for (const fidelity::HoldOutPoint& p : points)
    settings.points.push_back({p.position + p.skin * p.inward, p.inward});
  fem::IndentationSettings& indentation = settings.indentation;
  for (const double fraction : kLateralDepths)
    indentation.lateral_depths.push_back(fraction * indentation.depth);
  std::sort(indentation.lateral_depths.begin(), indentation.lateral_depths.end());
  const auto close = [](double a, double b) { return b - a < 1e-9; };
  auto& depths = indentation.lateral_depths;
  depths.erase(std::unique(depths.begin(), depths.end(), close), depths.end());
  indentation.azimuths.clear();
  for (const double degrees : kAzimuths)
    indentation.azimuths.push_back(degrees * std::numbers::pi / 180);
  indentation.lateral_increments = std::max(indentation.lateral_increments, kMinIncrements);
  if (space.c.certify.friction > 0) {
    indentation.friction = fem::ToolFriction::NoSlip;
    const int parts = (kStickingIncrements - 1) / indentation.increments + 1;
    indentation.increments *= parts;
  }
  return settings;
}

void require_same_body(const Curves& curves, const fs::path& body_file) {
  if (curves.body_sha256.empty() || curves.body_sha256 == sha256_of_file(body_file)) return;
  throw Error(ErrorKind::Configuration, body_file.string(),
              "the curves were computed on another body (its digest differs)",
              "run 'palpate build' again");
}

/// The depths of presses that are compared: those of the case and of the lateral paths. A press
/// that sticks passes more.
class ComparedDepths {
 public:
  ComparedDepths(const fem::IndentationSettings& own, const fem::IndentationSettings& direct)
      : depths_(direct.lateral_depths), tolerance_(kSameDepth * own.depth) {
    for (int i = 0; i <= own.increments; ++i) depths_.push_back(own.depth * i / own.increments);
  }
  bool contain(double depth) const {
    return std::any_of(depths_.begin(), depths_.end(),
                       [&](double compared) { return std::abs(depth - compared) < tolerance_; });
  }
  Curves of(Curves curves) const {
    const auto is_passed = [&](const CurveSample& sample) { return !contain(sample.displacement); };
    for (SiteCurves& site : curves.sites)
      for (CurvePath& path : site.paths)
        if (path.kind == PathKind::Normal)
          path.samples.erase(std::remove_if(path.samples.begin(), path.samples.end(), is_passed),
                             path.samples.end());
    return curves;
  }
  SiteFields of(SiteFields fields) const {
    const auto is_passed = [&](const NormalField& field) { return !contain(field.depth); };
    fields.normal.erase(std::remove_if(fields.normal.begin(), fields.normal.end(), is_passed),
                        fields.normal.end());
    return fields;
  }

 private:
  std::vector<double> depths_;
  double tolerance_;
};

/// The points must lie on the surface of every library.
void require_same_surface(const Library& library, const Body& body, const fs::path& file) {
  if (fitting::has_surface_of(body, library)) return;
  throw Error(ErrorKind::Configuration, file.string(),
              "its surface differs from that of the body of the case",
              "compare a library that was fitted on this body");
}

/// Digest of everything that the direct solutions depend on.
std::string direct_key(const Workspace& space, const fem::CampaignSettings& settings) {
  std::string text = fmt::format("fidelity within and beyond friction\n{}\n{}\n{}\n{}\n",
                                 sha256_of_file(space.body()), stage_case(space, Stage::Precompute),
                                 PALPATE_VERSION, settings.indentation.lateral_increments);
  if (settings.indentation.divide_once_more) text += "on a finer mesh\n";
  if (settings.indentation.friction == fem::ToolFriction::NoSlip)
    text += fmt::format("sticking, {}\n", settings.indentation.increments);
  for (const fem::PressPoint& p : settings.points)
    text += fmt::format("{} {} {} {} {} {}\n", p.position[0], p.position[1], p.position[2],
                        p.inward[0], p.inward[1], p.inward[2]);
  for (const double depth : settings.indentation.lateral_depths) text += fmt::format("{} ", depth);
  for (const double azimuth : settings.indentation.azimuths) text += fmt::format("{} ", azimuth);
  return sha256(text);
}

/// Direct solutions. Those of an earlier run are reused: they take minutes, and every library of
/// the body is compared with the same.
Curves solve_direct(const Workspace& space, const Body& body, fem::CampaignSettings settings) {
  SiteJournal journal(
      space.out / "fidelity.journal",
      {direct_key(space, settings), static_cast<std::int64_t>(settings.points.size())});
  settings.known = journal.found();
  settings.finished = [&](const SiteCurves& site) { journal.append(site); };
  if (space.c.deformation.depths > 0)
    keep_fields_in(direct_fields(space), settings.indentation.increments, settings);
  settings.field_friction = space.c.certify.friction;
  ProgressDisplay display("direct", console().out);
  settings.preloading = [&](const fem::PreloadProgress& p) {
    display.show(PreloadStep{p.steps, p.carried, p.shapes});
  };
  settings.progress = [&](const fem::CampaignProgress& p) {
    display.show({p.done, p.failed, p.running, p.total, p.known, p.sites, false});
  };
  settings.advanced = [&](const fem::CampaignProgress& p) {
    display.show({p.done, p.failed, p.running, p.total, p.known, p.sites, true});
  };
  fem::CampaignReport report;
  Curves direct = fem::run_campaign(body, settings, report);
  say("compare: {}, {} of them from an earlier run, in {} ({} CPU time)",
      count_text(settings.points.size(), "direct press", "direct presses"), settings.known.size(),
      duration_text(report.seconds), duration_text(report.cpu_seconds));
  return direct;
}

/// The rows of the skin; none where the library has no deformation file.
std::vector<fidelity::SkinErrorRow> skin_rows(const Workspace& space, const fs::path& library,
                                              const fidelity::RenderedBody& rendered,
                                              const std::vector<fidelity::HoldOutPoint>& points,
                                              const Curves& direct, const ComparedDepths& depths) {
  const fs::path file = library.parent_path() / space.deformation().filename();
  if (space.c.deformation.depths == 0 || !fs::exists(file)) return {};
  const auto fields = [&](const SiteCurves& site) {
    return depths.of(fields_of(direct_fields(space), site));
  };
  return fidelity::measure_skin(rendered, {rendered, file}, points, direct, fields,
                                space.c.certify.friction);
}

/// Depths are measured from the skin. Its distance from the flat triangles is an error of geometry,
/// reported apart from that of the force.
std::string skin_text(const std::vector<double>& distances) {
  if (distances.empty()) return {};
  return fmt::format(
      "the skin is {} (median), {} (worst) from the response triangles at the points "
      "off node; depths are measured from it\n",
      length_text(distances[distances.size() / 2]), length_text(distances.back()));
}

double bytes_per_node(const Library& library) {
  std::size_t numbers = 0, nodes = 0;
  for (const NodeResponse& node : library.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    ++nodes;
    for (const ResponseCurve* curve : {&node.normal, &node.lateral, &node.coupling.curve})
      numbers += curve->knot.size() + curve->slope.size();
    if (library.kind == ResponseKind::Coupled) ++numbers;  // w(0)
  }
  return nodes == 0 ? 0 : static_cast<double>(numbers * sizeof(float)) / static_cast<double>(nodes);
}

}  // namespace

bool run_fidelity(const Workspace& space, const FidelityOptions& options) {
  const Body body = read_input(space.body(), "mesh", read_body);
  const Curves sampled = read_input(space.curves(), "precompute", read_curves);
  require_same_body(sampled, space.body());
  std::vector<fs::path> files = options.libraries;
  if (files.empty()) files.push_back(space.library());
  prepare_output(space.out);
  std::vector<Library> libraries;
  for (const fs::path& file : files) {
    libraries.push_back(read_input(file, "fit", read_library));
    require_same_surface(libraries.back(), body, file);
  }
  auto points =
      fidelity::draw_points(libraries.front(), options.off_node, options.at_node, options.seed);
  std::string text = skin_text(fidelity::find_skin(body, points)), states;
  const fem::CampaignSettings pressed = direct_settings(space, options.finer_mesh, points);
  const Curves solved = solve_direct(space, body, pressed);
  const ComparedDepths depths(space.c.campaign.indentation, pressed.indentation);
  const Curves direct = depths.of(solved);

  const fidelity::FidelitySettings settings{
      options.floor > 0 ? options.floor : fidelity::relative_floor(direct, options.floor_fraction),
      space.c.certify.friction};
  text += floor_text(options, settings.floor);
  nlohmann::ordered_json json = fidelity_heading(options, settings, points);
  bool complete = true;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const fs::path& file = files[i];
    const Library& library = libraries[i];
    const fidelity::RenderedBody rendered(file);
    const fidelity::Fidelity result =
        fidelity::measure({library, rendered, points, direct, sampled}, settings);
    const auto skin = skin_rows(space, file, rendered, points, solved, depths);
    complete = complete && result.left_out.empty();
    std::error_code none;
    const LibrarySize size{bytes_per_node(library), fs::file_size(file, none)};
    text += fidelity_text(file.string(), result, size) + skin_error_text(skin);
    states += fidelity_states_csv(file.filename().string(), result, states.empty());
    json["libraries"].push_back(fidelity_json(file, result, size));
    json["libraries"].back()["skin"] = skin_error_json(skin);
  }
  print_text(text);
  write_file_crash_safely(space.out / "fidelity.txt", text);
  write_file_crash_safely(space.out / "fidelity.json", json.dump(1) + "\n");
  write_file_crash_safely(space.out / "fidelity-states.csv", states);
  say("compare: {}, fidelity.txt, fidelity-states.csv", (space.out / "fidelity.json").string());
  return complete;
}

}  // namespace palpate::app
