// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/watch/live_frame.hpp"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "runtime/palpate.h"

namespace palpate::app {
namespace {

using nlohmann::json;

constexpr std::size_t kParts = 8;  // of the steps between two frames, each with its extremes

/// The steps of least and largest force in equal parts of these, in the order of time.
std::vector<const RecordedStep*> extremes(const std::vector<RecordedStep>& steps) {
  std::vector<const RecordedStep*> found;
  const auto weaker = [](const RecordedStep& a, const RecordedStep& b) {
    return norm(a.force) < norm(b.force);
  };
  const std::size_t parts = std::min(kParts, steps.size());
  for (std::size_t i = 0; i < parts; ++i) {
    const auto first = steps.begin() + static_cast<std::ptrdiff_t>(i * steps.size() / parts);
    const auto end = steps.begin() + static_cast<std::ptrdiff_t>((i + 1) * steps.size() / parts);
    auto [low, high] = std::minmax_element(first, end, weaker);
    if (low > high) std::swap(low, high);
    found.push_back(&*low);
    if (high != low) found.push_back(&*high);
  }
  return found;
}

double seconds(const RecordedStep& step) {
  return 1e-9 * static_cast<double>(step.time_ns);
}

json last_step(const RecordedStep& step, const Vec3& origin) {
  return {{"time", seconds(step)},
          {"position", step.position - origin},
          {"contact", step.contact_point - origin},
          {"force", step.force},
          {"depth", step.depth},
          {"lateral", step.lateral},
          {"energy", step.energy},
          {"tank", step.tank},
          {"absorbed", step.absorbed},
          {"element", step.element},
          {"status", step.status}};
}

json columns(const std::vector<RecordedStep>& steps) {
  json time = json::array(), force = time, energy = time, tank = time, absorbed = time;
  for (const RecordedStep* step : extremes(steps)) {
    time.push_back(seconds(*step));
    force.push_back(norm(step->force));
    energy.push_back(step->energy);
    tank.push_back(step->tank);
    absorbed.push_back(step->absorbed);
  }
  return {
      {"time", time}, {"force", force}, {"energy", energy}, {"tank", tank}, {"absorbed", absorbed}};
}

}  // namespace

bool LiveFrames::see(const SessionNews& news) {
  if (news.begun) {
    heading_ = news.begun;
    ++session_;
    running_ = true;
    counts_ = {};
    last_.reset();
    recent_.clear();
  }
  for (const RecordedStep& step : news.steps) count(step);
  if (!news.steps.empty()) last_ = news.steps.back();
  recent_.insert(recent_.end(), news.steps.begin(), news.steps.end());
  if (news.ended) running_ = false;
  return news.begun || news.ended || !news.steps.empty();
}

void LiveFrames::count(const RecordedStep& step) {
  const auto one_if = [&](std::uint32_t bit) { return (step.status & bit) != 0 ? 1U : 0U; };
  ++counts_.steps;
  counts_.contact += one_if(PALPATE_CONTACT);
  counts_.beyond_depth += one_if(PALPATE_BEYOND_DEPTH);
  counts_.late += one_if(PALPATE_LOOP_LATE);
  counts_.clamped += one_if(PALPATE_LOOP_CLAMPED);
  counts_.largest_force = std::max(counts_.largest_force, norm(step.force));
  counts_.least_margin = std::min(counts_.least_margin, step.absorbed - step.energy - step.tank);
}

std::string LiveFrames::next() {
  json frame = {{"session", session_}, {"running", running_}};
  if (heading_) {
    frame["device"] = heading_->device;
    frame["rate"] = heading_->rate;
    frame["friction"] = heading_->friction;
    frame["same_library"] =
        heading_->library_sha256.empty() || heading_->library_sha256 == library_sha256_;
    frame["counts"] = {{"steps", counts_.steps},
                       {"contact", counts_.contact},
                       {"beyond_depth", counts_.beyond_depth},
                       {"late", counts_.late},
                       {"clamped", counts_.clamped},
                       {"largest_force", counts_.largest_force},
                       {"least_margin", counts_.least_margin}};
  }
  frame["last"] = last_ ? last_step(*last_, heading_->settings.body_position) : json(nullptr);
  frame["recent"] = columns(recent_);
  recent_.clear();
  return frame.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace palpate::app
