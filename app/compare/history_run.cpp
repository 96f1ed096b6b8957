// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/history_run.hpp"

#include <algorithm>
#include <cmath>

#include "app/compare/time_tables.hpp"
#include "app/console.hpp"
#include "app/measured/histories.hpp"
#include "app/pipeline/settings.hpp"
#include "app/report/report.hpp"
#include "fem/relaxation/relaxing_press.hpp"
#include "fitting/fidelity/rendered_press.hpp"
#include "format/crash_safe_file.hpp"
#include "format/error.hpp"
#include "format/library.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

void add_library(const Histories& histories, const fs::path& file,
                 std::vector<ComparedHistory>& compared) {
  const Library library = read_library(file);
  require_same_tool(histories, library.tool_shape, library.tool_radius, file.string());
  const fidelity::RenderedBody body(file);
  for (const SiteHistory& site : histories.records) {
    const auto vertex = static_cast<std::size_t>(site.vertex);
    if (vertex >= library.positions.size() ||
        library.responses[vertex].status == ResponseStatus::Hole)
      refuse(file.string(), fmt::format("it has no response at vertex {}", site.vertex),
             "compare with a library of the body of the records");
    const std::vector<double> force = body.follow(library.positions[vertex], library.inward[vertex],
                                                  site.history.time, site.history.travel);
    compared.push_back(
        {site.history.name, site.vertex, "library", compare::over_time(site.history, force)});
  }
}

/// From the last sample out of contact on, of straight lines.
std::vector<fem::ToolMotion> motion_of(const measured::History& h, std::size_t first) {
  constexpr double kTolerance = 2e-3;  // of the largest travel
  const auto tail = [&](const std::vector<double>& v) {
    return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(first), v.end());
  };
  std::vector<double> time = tail(h.time), travel = tail(h.travel);
  travel.front() = std::min(travel.front(), 0.0);
  const double deepest = *std::max_element(travel.begin(), travel.end());
  std::vector<fem::ToolMotion> motion;
  for (const std::size_t i : compare::corners_of(time, travel, kTolerance * deepest))
    motion.push_back({time[i] - time.front(), travel[i]});
  return motion;
}

double interpolated(const std::vector<fem::RelaxingSample>& samples, const Vec3& inward, double t) {
  const auto after = std::find_if(samples.begin(), samples.end(),
                                  [&](const fem::RelaxingSample& s) { return s.time_s >= t; });
  const auto force = [&](const fem::RelaxingSample& s) { return dot(s.force, inward); };
  if (after == samples.begin()) return force(samples.front());
  if (after == samples.end()) return force(samples.back());
  const fem::RelaxingSample &a = *(after - 1), &b = *after;
  if (!(b.time_s > a.time_s)) return force(b);
  return force(a) + (force(b) - force(a)) * (t - a.time_s) / (b.time_s - a.time_s);
}

ComparedHistory direct(const Body& body, const fem::CampaignSettings& settings,
                       const SiteHistory& site) {
  const measured::History& h = site.history;
  std::size_t first = 0;
  while (first + 1 < h.travel.size() && !(h.travel[first + 1] > 0)) ++first;
  const fem::RelaxingPress press =
      fem::press_relaxing(body, settings, site.vertex, motion_of(h, first));
  if (!press.complete)
    refuse(h.name, "the direct solution ends early: " + press.reason,
           "press less deep, or refine the mesh under the tool");
  const Vec3& inward = body.response.inward[static_cast<std::size_t>(site.vertex)];
  std::vector<double> force;
  for (const double t : h.time)
    force.push_back(t < h.time[first] ? 0 : interpolated(press.samples, inward, t - h.time[first]));
  return {h.name, site.vertex, "direct", compare::over_time(h, force)};
}

void write(const std::vector<ComparedHistory>& compared, const Histories& histories,
           const fs::path& file, const fs::path& out) {
  const nlohmann::ordered_json json = {{"artifact", "palpate.over-time"},
                                       {"schema", 1},
                                       {"name", histories.name},
                                       {"source", histories.source},
                                       {"licence", histories.licence},
                                       {"input_sha256", sha256_of_file(file)},
                                       {"records", time_comparison_json(compared)}};
  say_time_comparison(compared);
  prepare_output(out);
  write_file_crash_safely(out / "over-time.json", json.dump() + "\n");
  write_file_crash_safely(out / "over-time.csv", time_comparison_csv(compared));
  report::write_page({{"title", histories.name}, {"over_time", json}}, out / "over-time.html");
  say("compare: {}, over-time.csv, over-time.html", (out / "over-time.json").string());
}

}  // namespace

void compare_histories(const fs::path& file, const fs::path& library, const fs::path& out) {
  const Histories histories = histories_with_sites(file);
  std::vector<ComparedHistory> compared;
  add_library(histories, library, compared);
  say("compare: {} against {}, over time", library.string(), file.string());
  write(compared, histories, file, out);
}

void compare_histories_with_fem(const Workspace& space, const fs::path& file) {
  const Histories histories = histories_with_sites(file);
  const Body body = read_body(space.body());
  if (!histories.body_sha256.empty() && histories.body_sha256 != sha256_of_file(space.body()))
    refuse(file.string(), "it belongs to another body than " + space.body().string(),
           "import the records again with --body " + space.body().string());
  const fem::CampaignSettings settings = campaign_settings(space);
  std::vector<ComparedHistory> compared;
  if (fs::exists(space.library())) add_library(histories, space.library(), compared);
  for (const SiteHistory& site : histories.records)
    compared.push_back(direct(body, settings, site));
  say("compare: direct solutions of {} against {}, over time", space.c.name, file.string());
  write(compared, histories, file, space.out);
}

}  // namespace palpate::app
