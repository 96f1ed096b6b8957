// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/embed.hpp"
#include "app/report/figures.hpp"
#include "app/report/page_data.hpp"
#include "runtime/palpate.h"

namespace palpate::report {

namespace {

using nlohmann::json;

/// Counted over every step of the session, not only over those that are drawn.
json status_counts(const SessionDigest& session) {
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
  for (const auto& [name, bit] : bits) counts[name] = session.count(bit);
  return counts;
}

json latency_data(const SessionDigest& session) {
  std::vector<double> latency = session.latencies();
  if (latency.empty()) return {};
  return {{"p50", percentile(latency, 0.5)},
          {"p99", percentile(latency, 0.99)},
          {"p999", percentile(latency, 0.999)},
          {"max", percentile(latency, 1.0)},
          {"steps", latency.size()}};
}

/// Points are in the frame of the body.
json drawn_columns(const SessionDigest& session) {
  const Vec3& origin = session.heading().settings.body_position;
  std::vector<float> time, position, fx, fy, fz, depth, lateral, energy, tank, absorbed, contact;
  std::vector<std::int32_t> element;
  for (const RecordedStep& step : session.drawn()) {
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
    for (const double x : step.contact_point - origin) add(contact, x);
    for (const double x : step.position - origin) add(position, x);
    element.push_back(step.element);
  }
  return {
      {"time", column(time)},       {"fx", column(fx)},           {"fy", column(fy)},
      {"fz", column(fz)},           {"depth", column(depth)},     {"lateral", column(lateral)},
      {"energy", column(energy)},   {"tank", column(tank)},       {"absorbed", column(absorbed)},
      {"contact", column(contact)}, {"element", column(element)}, {"position", column(position)}};
}

}  // namespace

json session_data(const SessionDigest& session) {
  const RecordingHeading& heading = session.heading();
  json result = {{"device", heading.device},
                 {"rate", heading.rate},
                 {"friction", heading.friction},
                 {"steps", session.steps()}};
  if (session.steps() == 0) return result;
  result["max_force"] = session.max_force();
  result["duration"] = session.duration();
  result["counts"] = status_counts(session);
  result["latency"] = latency_data(session);
  result["margin"] = {{"least", session.least_margin()}, {"time", session.least_margin_time()}};
  result["drawn"] = drawn_columns(session);
  return result;
}

}  // namespace palpate::report
