// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/compare/over_time.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "format/error.hpp"

namespace palpate::compare {

using measured::History;
using measured::Phase;
using measured::PhaseKind;

namespace {

/// Mean over samples begin .. end - 1.
double mean(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += values[i];
  return sum / static_cast<double>(end - begin);
}

HeldForce held_force(const History& history, const std::vector<double>& model, const Phase& phase) {
  constexpr std::size_t kPart = 100;
  const std::size_t few = std::max<std::size_t>(1, (phase.end - phase.begin) / kPart);
  const auto left = [&](const std::vector<double>& force) {
    return mean(force, phase.end - few, phase.end) / mean(force, phase.begin, phase.begin + few);
  };
  return {history.time[phase.begin], history.time[phase.end - 1], left(history.force), left(model)};
}

double work(const std::vector<double>& force, const std::vector<double>& travel) {
  double sum = 0;
  for (std::size_t i = 1; i < force.size(); ++i)
    sum += 0.5 * (force[i] + force[i - 1]) * (travel[i] - travel[i - 1]);
  return sum;
}

bool is_released(const History& history) {
  return std::any_of(history.phases.begin(), history.phases.end(),
                     [](const Phase& phase) { return phase.kind == PhaseKind::Release; });
}

}  // namespace

TimeComparison over_time(const History& history, const std::vector<double>& model) {
  if (model.size() != history.time.size())
    throw Error(ErrorKind::Internal, history.name, "the model has another number of samples",
                "report this as a bug");
  const auto ramp = std::find_if(history.phases.begin(), history.phases.end(),
                                 [](const Phase& phase) { return phase.kind == PhaseKind::Ramp; });
  if (ramp == history.phases.end())
    refuse(history.name, "it has no ramp into the body", "declare its phases in the sidecar");
  TimeComparison c;
  const auto from = [&](const std::vector<double>& values) {
    return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(ramp->begin),
                               values.end());
  };
  c.time = from(history.time);
  c.travel = from(history.travel);
  c.measured = from(history.force);
  c.model = from(model);
  double squares = 0;
  for (std::size_t i = 0; i < c.time.size(); ++i) {
    const double off = c.model[i] - c.measured[i];
    squares += off * off;
    c.bias += off;
    if (std::abs(off) <= std::abs(c.worst)) continue;
    c.worst = off;
    c.worst_time = c.time[i];
  }
  const auto n = static_cast<double>(c.time.size());
  const auto largest = [](const std::vector<double>& v) {
    return *std::max_element(v.begin(), v.end());
  };
  c.rmse = std::sqrt(squares / n);
  c.bias /= n;
  c.normalised_rmse = c.rmse / largest(c.measured);
  c.peak_error = largest(c.model) - largest(c.measured);
  if (is_released(history)) {
    c.measured_loss = work(c.measured, c.travel);
    c.model_loss = work(c.model, c.travel);
  }
  for (const Phase& phase : history.phases)
    if (phase.kind == PhaseKind::Hold && history.control == measured::Control::Travel)
      c.holds.push_back(held_force(history, model, phase));
  return c;
}

std::vector<std::size_t> corners_of(const std::vector<double>& time,
                                    const std::vector<double>& travel, double tolerance) {
  std::vector<char> kept(time.size(), 0);
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, time.size() - 1}};
  kept.front() = kept.back() = 1;
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double most = tolerance;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double part = (time[i] - time[first]) / (time[last] - time[first]);
      const double off =
          std::abs(travel[i] - travel[first] - part * (travel[last] - travel[first]));
      if (off <= most) continue;
      most = off;
      farthest = i;
    }
    if (farthest == first) continue;
    kept[farthest] = 1;
    open.emplace_back(first, farthest);
    open.emplace_back(farthest, last);
  }
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i] != 0) corners.push_back(i);
  return corners;
}

}  // namespace palpate::compare
