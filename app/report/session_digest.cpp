// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/session_digest.hpp"

#include <algorithm>
#include <bit>

namespace palpate::report {
namespace {

std::array<double, 4> keys(const RecordedStep& step) {
  return {norm(step.force), step.depth, step.energy, static_cast<double>(step.latency_ns)};
}

}  // namespace

SessionDigest::SessionDigest(RecordingHeading heading, std::uint64_t steps, std::size_t buckets)
    : heading_(std::move(heading)),
      length_(std::max<std::size_t>(1, (steps + buckets - 1) / buckets)),
      most_changes_(buckets) {}

void SessionDigest::add(const RecordedStep& step) {
  max_force_ = std::max(max_force_, norm(step.force));
  for (std::size_t bit = 0; bit < bits_.size(); ++bit) bits_[bit] += (step.status >> bit) & 1U;
  if (step.latency_ns > 0) latencies_.push_back(1e-9 * static_cast<double>(step.latency_ns));
  const double margin = step.absorbed - step.energy - step.tank;
  if (margin < least_margin_) {
    least_margin_ = margin;
    least_margin_time_ = 1e-9 * static_cast<double>(step.time_ns);
  }
  const bool changed = count_ > 0 && (step.element >= 0) != (last_.element >= 0);
  if (changed && changes_ < most_changes_) {
    drawn_.emplace_back(count_ - 1, last_);
    drawn_.emplace_back(count_, step);
    ++changes_;
  }
  note_extremes(step);
  last_ = step;
  ++count_;
  if (++in_bucket_ < length_) return;
  close_bucket(drawn_);
  in_bucket_ = 0;
}

void SessionDigest::note_extremes(const RecordedStep& step) {
  if (in_bucket_ == 0) {
    drawn_.emplace_back(count_, step);
    lowest_.fill({count_, step});
    highest_ = lowest_;
    return;
  }
  const auto now = keys(step);
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (now[k] < keys(lowest_[k].second)[k]) lowest_[k] = {count_, step};
    if (now[k] >= keys(highest_[k].second)[k]) highest_[k] = {count_, step};
  }
}

/// The first and the last step of a bucket are drawn.
void SessionDigest::close_bucket(std::vector<Numbered>& drawn) const {
  drawn.emplace_back(count_ - 1, last_);
  drawn.insert(drawn.end(), lowest_.begin(), lowest_.end());
  drawn.insert(drawn.end(), highest_.begin(), highest_.end());
}

std::size_t SessionDigest::count(std::uint32_t bit) const {
  return bits_[static_cast<std::size_t>(std::countr_zero(bit))];
}

std::vector<RecordedStep> SessionDigest::drawn() const {
  std::vector<Numbered> all = drawn_;
  if (in_bucket_ > 0) close_bucket(all);
  const auto before = [](const Numbered& a, const Numbered& b) { return a.first < b.first; };
  const auto same = [](const Numbered& a, const Numbered& b) { return a.first == b.first; };
  std::sort(all.begin(), all.end(), before);
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  std::vector<RecordedStep> steps;
  for (const Numbered& numbered : all) steps.push_back(numbered.second);
  return steps;
}

SessionDigest digest(RecordingReader& reader) {
  SessionDigest all(reader.heading(), reader.steps());
  for (auto steps = reader.next(); !steps.empty(); steps = reader.next())
    for (const RecordedStep& step : steps) all.add(step);
  return all;
}

SessionDigest digest(const Recording& recording) {
  SessionDigest all(recording, recording.steps.size());
  for (const RecordedStep& step : recording.steps) all.add(step);
  return all;
}

}  // namespace palpate::report
