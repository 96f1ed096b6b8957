// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/phases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fitting/measurement/records/cycles.hpp"

namespace palpate::measured {
namespace {

constexpr std::array<std::pair<PhaseKind, std::string_view>, 5> kNames{
    {{PhaseKind::Approach, "approach"},
     {PhaseKind::Rest, "rest"},
     {PhaseKind::Ramp, "ramp"},
     {PhaseKind::Hold, "hold"},
     {PhaseKind::Release, "release"}}};

/// Part of the largest force below which a tool that holds still is out of contact.
constexpr double kNoForce = 0.05;
constexpr double kTurn = 0.05;  ///< of the range, a turn that counts

struct Span {
  std::size_t begin = 0, end = 0;
};

double range_of(const std::vector<double>& y) {
  if (y.empty()) return 0;
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  return *high - *low;
}

/// Extremes between which the signal moves one way, the ends of the span included.
std::vector<std::size_t> turning_points(const std::vector<double>& y, Span span, double turn) {
  std::vector<std::size_t> points{span.begin};
  std::size_t low = span.begin, high = span.begin;
  int way = 0;
  for (std::size_t i = span.begin; i < span.end; ++i) {
    if (y[i] > y[high]) high = i;
    if (y[i] < y[low]) low = i;
    if (way >= 0 && y[high] - y[i] > turn) {
      if (high > points.back()) points.push_back(high);
      way = -1;
      low = i;
    } else if (way <= 0 && y[i] - y[low] > turn) {
      if (low > points.back()) points.push_back(low);
      way = 1;
      high = i;
    }
    if (way > 0) low = i;
    if (way < 0) high = i;
  }
  const std::size_t last = span.end - 1;
  if (last > points.back()) points.push_back(last);
  return points;
}

double path_of(const std::vector<double>& y, double turn) {
  const std::vector<std::size_t> points = turning_points(y, {0, y.size()}, turn);
  double path = 0;
  for (std::size_t i = 1; i < points.size(); ++i) path += std::abs(y[points[i]] - y[points[i - 1]]);
  return path;
}

/// Runs within the band that last for `shortest` or longer.
std::vector<Span> still_runs(const std::vector<double>& time, const std::vector<double>& y,
                             double band, double shortest) {
  constexpr std::size_t kFewest = 10;
  std::vector<Span> runs;
  for (std::size_t i = 0; i < y.size();) {
    double low = y[i], high = y[i];
    std::size_t next = i + 1;
    for (; next < y.size(); ++next) {
      low = std::min(low, y[next]);
      high = std::max(high, y[next]);
      if (high - low > band) break;
    }
    const bool still = next - i >= kFewest && time[next - 1] - time[i] >= shortest;
    if (still) runs.push_back({i, next});
    i = still ? next : i + 1;
  }
  return runs;
}

double duration(const std::vector<double>& time, const Span& span) {
  return time[span.end - 1] - time[span.begin];
}

std::vector<Span> holds_of(const std::vector<double>& time, const std::vector<double>& y,
                           double part) {
  constexpr double kSlower = 30;
  constexpr int kPasses = 4;
  const double range = range_of(y), noise = noise_of(y);
  if (!(range > 0)) return {};
  const double band = std::max(part * range, 4 * noise);
  const double path = std::max(range, path_of(y, std::max(kTurn * range, 6 * noise)));
  double moving = time.back() - time.front();
  std::vector<Span> holds;
  // The holds are no part of the time that the motion takes.
  for (int pass = 0; pass < kPasses; ++pass) {
    holds = still_runs(time, y, band, kSlower * moving * band / path);
    double held = 0;
    for (const Span& hold : holds) held += duration(time, hold);
    moving = time.back() - time.front() - held;
  }
  return holds;
}

class Sorter {
 public:
  Sorter(const PhaseSignals& signals, Control control)
      : s_(signals), y_(control == Control::Travel ? signals.displacement : signals.force) {
    holds_ = holds_of(s_.time, y_, control == Control::Travel ? 0.01 : 0.02);
    turn_ = std::max(kTurn * range_of(y_), 6 * noise_of(y_));
    largest_ = *std::max_element(s_.force.begin(), s_.force.end());
  }

  double longest_hold() const {
    double longest = 0;
    for (const Span& hold : holds_)
      if (in_contact(hold)) longest = std::max(longest, duration(s_.time, hold));
    return longest;
  }

  std::vector<Phase> phases() const {
    std::vector<Phase> phases;
    std::size_t done = 0;
    for (const Span& hold : holds_) {
      add_motion({done, hold.begin}, phases);
      add_still(hold, phases);
      done = hold.end;
    }
    add_motion({done, s_.time.size()}, phases);
    return phases;
  }

 private:
  bool in_contact(const Span& span) const {
    const std::size_t middle = (span.begin + span.end) / 2;
    return s_.travel[middle] > 0 && s_.force[middle] > kNoForce * largest_;
  }

  static void add(Phase phase, std::vector<Phase>& phases) {
    if (phase.begin >= phase.end) return;
    if (!phases.empty() && phases.back().kind == phase.kind && phase.kind != PhaseKind::Hold)
      phases.back().end = phase.end;
    else
      phases.push_back(phase);
  }

  void add_still(const Span& span, std::vector<Phase>& phases) const {
    if (in_contact(span)) return add({PhaseKind::Hold, span.begin, span.end}, phases);
    // A force that is held at zero says nothing of a tool that moves out of contact.
    const double moved = s_.displacement[span.end - 1] - s_.displacement[span.begin];
    const bool still = std::abs(moved) <= 0.01 * range_of(s_.displacement);
    add({still       ? PhaseKind::Rest
         : moved > 0 ? PhaseKind::Approach
                     : PhaseKind::Release,
         span.begin, span.end},
        phases);
  }

  void add_motion(const Span& span, std::vector<Phase>& phases) const {
    if (span.begin >= span.end) return;
    const std::vector<std::size_t> points = turning_points(y_, span, turn_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      // From the extreme on; what is left of a span belongs to its last part.
      if (i + 1 == points.size() && i > 0) break;
      const std::size_t begin = points[i];
      const bool last = i + 2 >= points.size();
      const std::size_t end = last ? span.end : points[i + 1];
      const double to = end < y_.size() ? y_[end] : y_[end - 1];
      if (to < y_[begin]) {
        add({PhaseKind::Release, begin, end}, phases);
        continue;
      }
      std::size_t touch = begin;
      while (touch < end && s_.travel[touch] <= 0) ++touch;
      add({PhaseKind::Approach, begin, touch}, phases);
      add({PhaseKind::Ramp, touch, end}, phases);
    }
  }

  PhaseSignals s_;
  const std::vector<double>& y_;
  std::vector<Span> holds_;
  double turn_ = 0, largest_ = 0;
};

}  // namespace

std::string_view phase_name(PhaseKind kind) {
  for (const auto& [value, name] : kNames)
    if (value == kind) return name;
  return "";
}

std::optional<PhaseKind> phase_of_name(std::string_view name) {
  for (const auto& [value, known] : kNames)
    if (known == name) return value;
  return std::nullopt;
}

Control control_of(const PhaseSignals& signals) {
  constexpr double kAlike = 1.1;
  const double travel = Sorter(signals, Control::Travel).longest_hold();
  const double force = Sorter(signals, Control::Force).longest_hold();
  return force > kAlike * travel ? Control::Force : Control::Travel;
}

std::vector<Phase> phases_of(const PhaseSignals& signals, Control control) {
  return Sorter(signals, control).phases();
}

}  // namespace palpate::measured
