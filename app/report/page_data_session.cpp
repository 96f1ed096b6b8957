// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "app/report/embed.hpp"
#include "app/report/figures.hpp"
#include "app/report/page_data.hpp"
#include "runtime/palpate.h"

namespace palpate::report {

namespace {

using nlohmann::json;

constexpr std::size_t kBuckets = 600;  // about the width in pixels of a plot over time

/// Counted over every step of the session, not only over those that are drawn.
json status_counts(const Recording& recording) {
  const std::pair<const char*, std::uint32_t> bits[] = {{"contact", PALPATE_CONTACT},
                                                        {"activated", PALPATE_ACTIVATED},
                                                        {"released", PALPATE_RELEASED},
                                                        {"sliding", PALPATE_SLIDING},
                                                        {"at_border", PALPATE_AT_BORDER},
                                                        {"energy_limited", PALPATE_ENERGY_LIMITED},
                                                        {"beyond_depth", PALPATE_BEYOND_DEPTH},
                                                        {"bad_input", PALPATE_BAD_INPUT},
                                                        {"dropped", PALPATE_DROPPED}};
  json counts = json::object();
  for (const auto& [name, bit] : bits) {
    const auto has = [mask = bit](const RecordedStep& s) { return (s.status & mask) != 0; };
    counts[name] = std::count_if(recording.steps.begin(), recording.steps.end(), has);
  }
  return counts;
}

json latency_data(const Recording& recording) {
  std::vector<double> latency;
  for (const RecordedStep& step : recording.steps) {
    if (step.latency_ns > 0) latency.push_back(static_cast<double>(step.latency_ns) * 1e-9);
  }
  if (latency.empty()) return {};
  return {{"p50", percentile(latency, 0.5)},
          {"p99", percentile(latency, 0.99)},
          {"p999", percentile(latency, 0.999)},
          {"max", percentile(latency, 1.0)},
          {"steps", latency.size()}};
}

/// Passive as long as the work absorbed covers what is stored: absorbed >= energy + tank.
json margin_data(const Recording& recording) {
  double least = std::numeric_limits<double>::infinity();
  std::int64_t when = 0;
  for (const RecordedStep& step : recording.steps) {
    const double margin = step.absorbed - step.energy - step.tank;
    if (margin >= least) continue;
    least = margin;
    when = step.time_ns;
  }
  return {{"least", least}, {"time", static_cast<double>(when) * 1e-9}};
}

json drawn_columns(const Recording& recording) {
  std::vector<float> time, fx, fy, fz, depth, lateral, energy, tank, absorbed, contact;
  std::vector<std::int32_t> element;
  for (const std::size_t i : thin_session(recording, kBuckets)) {
    const RecordedStep& step = recording.steps[i];
    const auto add = [](std::vector<float>& out, double x) {
      out.push_back(static_cast<float>(x));
    };
    add(time, static_cast<double>(step.time_ns) * 1e-9);
    add(fx, step.force[0]);
    add(fy, step.force[1]);
    add(fz, step.force[2]);
    add(depth, step.depth);
    add(lateral, step.lateral);
    add(energy, step.energy);
    add(tank, step.tank);
    add(absorbed, step.absorbed);
    for (const double x : step.contact_point) add(contact, x);
    element.push_back(step.element);
  }
  return {{"time", column(time)},       {"fx", column(fx)},          {"fy", column(fy)},
          {"fz", column(fz)},           {"depth", column(depth)},    {"lateral", column(lateral)},
          {"energy", column(energy)},   {"tank", column(tank)},      {"absorbed", column(absorbed)},
          {"contact", column(contact)}, {"element", column(element)}};
}

}  // namespace

json session_data(const Recording& recording) {
  json result = {{"device", recording.device},
                 {"rate", recording.rate},
                 {"friction", recording.friction},
                 {"steps", recording.steps.size()}};
  if (recording.steps.empty()) return result;
  double max_force = 0;
  for (const RecordedStep& step : recording.steps)
    max_force = std::max(max_force, norm(step.force));
  result["max_force"] = max_force;
  result["duration"] = static_cast<double>(recording.steps.back().time_ns) * 1e-9;
  result["counts"] = status_counts(recording);
  result["latency"] = latency_data(recording);
  result["margin"] = margin_data(recording);
  result["drawn"] = drawn_columns(recording);
  return result;
}

}  // namespace palpate::report
