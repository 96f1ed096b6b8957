// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/delay_spread.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fitting/measurement/identify/axis_equations.hpp"
#include "fitting/measurement/identify/weak_form.hpp"

namespace palpate::identify {
namespace {

constexpr double kWidest = 0.02, kNarrowest = 0.008;  // s, half of a window
constexpr double kLargeJump = 0.5;                    // of the largest: smaller ones are not dated
constexpr std::size_t kFewestDates = 15;
constexpr double kFast = 0.5;           // of the largest speed
constexpr std::size_t kNeighbours = 5;  // on either side
constexpr std::size_t kFewestPlaces = 100;

double jump_of(const MotionRecord& record, std::size_t row) {
  return record.command[row][record.axis] - record.command[row - 1][record.axis];
}

/// The largest window around a time in which the tip moves one way.
std::optional<Window> window_around(const MotionRecord& record, const std::vector<double>& velocity,
                                    double time) {
  const auto at = std::lower_bound(record.time.begin(), record.time.end(), time);
  const auto middle = static_cast<std::size_t>(at - record.time.begin());
  if (middle == 0 || middle >= velocity.size()) return {};
  const auto one_way = [&](std::size_t i) { return velocity[i] * velocity[middle] > 0; };
  std::size_t first = middle, last = middle;
  while (first > 0 && one_way(first - 1)) --first;
  while (last + 1 < velocity.size() && one_way(last + 1)) ++last;
  const double half = std::min({time - record.time[first], record.time[last] - time, kWidest});
  if (!(half > kNarrowest)) return {};
  return Window{time - half, time + half, velocity[middle] > 0 ? 1.0 : -1.0};
}

/// The time in a window until which the antiderivative of phi grows to a value.
double time_of(const TestFunction& phi, const Window& window, double value) {
  double low = window.begin, high = window.end;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (phi.integral_until(middle) < value ? low : high) = middle;
  }
  return (low + high) / 2;
}

void date_jumps(const MotionRecord& record, const AxisEquations& equations, const EquationFit& fit,
                double delay, DelaySpread& spread) {
  double largest = 0;
  for (const std::size_t row : record.jump)
    if (row > 0) largest = std::max(largest, std::abs(jump_of(record, row)));
  const std::vector<double> velocity = smooth_velocity(record, record.axis);
  Measured latest;
  for (const std::size_t row : record.jump) {
    if (row == 0) continue;
    const double jump = jump_of(record, row), expected = record.time[row] + delay;
    const std::optional<Window> window = window_around(record, velocity, expected);
    if (!window || std::abs(jump) < kLargeJump * largest) continue;
    const TestFunction phi(*window);
    const double misfit = equations.impulse_misfit(*window, fit, delay);
    const double date = time_of(phi, *window, phi.integral() / 2 + misfit / jump);
    const Measured found{delay + date - expected,
                         equations.impulse_deviation(*window, fit) / std::abs(jump)};
    ++spread.dated;
    if (spread.dated == 1 || found.high() > latest.high()) latest = found;
  }
  if (spread.dated >= kFewestDates) spread.latest = latest;
}

/// Distance of a position from the parabola through its neighbours, m.
double distance_from_parabola(const MotionRecord& record, std::size_t i) {
  constexpr auto kRows = static_cast<Eigen::Index>(2 * kNeighbours);
  Eigen::Matrix<double, kRows, 3> a;
  Eigen::Matrix<double, kRows, 1> x;
  const double scale = record.time[i + kNeighbours] - record.time[i];
  Eigen::Index row = 0;
  for (std::size_t j = i - kNeighbours; j <= i + kNeighbours; ++j) {
    if (j == i) continue;
    const double t = (record.time[j] - record.time[i]) / scale;
    a.row(row) << 1, t, t * t;
    x[row++] = record.position[j][record.axis] - record.position[i][record.axis];
  }
  return -a.colPivHouseholderQr().solve(x)[0];
}

void measure_lateness(const MotionRecord& record, DelaySpread& spread) {
  const std::vector<double> velocity = smooth_velocity(record, record.axis);
  const std::size_t end = record.sine_rows();
  double largest = 0;
  for (std::size_t i = 0; i < end; ++i) largest = std::max(largest, std::abs(velocity[i]));
  double late = 0, early = 0;
  std::size_t places = 0;
  for (std::size_t i = kNeighbours; i + kNeighbours < end; ++i) {
    if (std::abs(velocity[i]) < kFast * largest) continue;
    const double lateness = -distance_from_parabola(record, i) / velocity[i];
    late = std::max(late, lateness), early = std::min(early, lateness);
    ++places;
  }
  if (places < kFewestPlaces) return;
  spread.lateness = late;
  spread.lateness_range = late - early;
}

}  // namespace

DelaySpread delay_spread(const MotionRecord& record, const AxisEquations& equations,
                         const EquationFit& fit, double delay) {
  DelaySpread spread;
  date_jumps(record, equations, fit, delay, spread);
  measure_lateness(record, spread);
  return spread;
}

double delay_bound(const Measured& mean, const DelaySpread& spread, double longer) {
  constexpr double kOfPeriod = 0.75;
  if (std::isnan(spread.latest.value) || std::isnan(spread.lateness)) return kUnknown;
  return std::max(mean.high(), spread.latest.high()) + spread.lateness +
         kOfPeriod * (longer + spread.lateness_range);
}

}  // namespace palpate::identify
