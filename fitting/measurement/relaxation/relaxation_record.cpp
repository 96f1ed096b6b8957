// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/relaxation/relaxation_record.hpp"

#include <algorithm>

#include "fitting/measurement/records/statistics.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::calibrate {

using measured::History;
using measured::Phase;
using measured::PhaseKind;

namespace {

/// One past the last sample that is used.
std::size_t end_of(const History& history) {
  for (auto phase = history.phases.rbegin(); phase != history.phases.rend(); ++phase)
    if (phase->kind == PhaseKind::Hold) return phase->end;
  return history.time.size();
}

/// The last sample that is still out of contact, or the first.
std::size_t touch_of(const History& history, std::size_t end) {
  const auto deepest = std::max_element(history.travel.begin(),
                                        history.travel.begin() + static_cast<std::ptrdiff_t>(end)) -
                       history.travel.begin();
  auto touch = static_cast<std::size_t>(deepest);
  for (const Phase& phase : history.phases) {
    if (phase.kind != PhaseKind::Ramp) continue;
    touch = phase.begin;
    break;
  }
  while (touch > 0 && history.travel[touch] > 0) --touch;
  return touch;
}

/// From the contact to the end of the first motion into the body.
double ramp_of(const History& history, std::size_t touch) {
  for (const Phase& phase : history.phases)
    if (phase.kind == PhaseKind::Ramp)
      return history.time[std::min(phase.end, history.time.size() - 1)] - history.time[touch];
  return 0;
}

}  // namespace

double RelaxationRecord::interval() const {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) steps.push_back(time[i] - time[i - 1]);
  return measured::median(steps);
}

RelaxationRecord relaxation_record(const History& history, std::size_t most) {
  require_time_dependence(history);
  const std::size_t end = end_of(history), touch = touch_of(history, end);
  RelaxationRecord record;
  record.name = history.name;
  record.force_is_held = history.control == measured::Control::Force;
  record.ramp = ramp_of(history, touch);
  record.stride = (end - touch + most - 1) / most;
  for (std::size_t i = touch; i < end; i += record.stride) {
    record.time.push_back(history.time[i]);
    record.travel.push_back(std::max(0.0, history.travel[i]));
    record.force.push_back(history.force[i]);
  }
  constexpr double kDeep = 0.2;
  const double deepest = *std::max_element(record.travel.begin(), record.travel.end());
  if (record.travel.front() > kDeep * deepest) {
    refuse(record.name,
           "its first sample is " + number_text(1e3 * record.travel.front()) + " mm deep, of " +
               number_text(1e3 * deepest) + " mm: the ramp is not recorded",
           "record from before the contact; a step that takes no time is never assumed");
  }
  return record;
}

}  // namespace palpate::calibrate
