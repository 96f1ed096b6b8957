// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/weak_form.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::identify {
namespace {

constexpr std::ptrdiff_t kHalfWidth = 5;              // samples on either side of a slope
constexpr double kLongest = 0.06, kShortest = 0.015;  // s, of a window
constexpr double kSlow = 0.05;                        // of the largest speed
constexpr double kPeak = 1024;                        // 1/max of s^5 (1 - s)^5

/// Slope of the least-squares line through samples first .. last.
double slope_of(const MotionRecord& record, std::size_t axis, std::size_t first, std::size_t last) {
  const auto n = static_cast<double>(last - first + 1);
  double t = 0, x = 0;
  for (std::size_t i = first; i <= last; ++i) t += record.time[i], x += record.position[i][axis];
  t /= n, x /= n;
  double tt = 0, tx = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const double dt = record.time[i] - t;
    tt += dt * dt;
    tx += dt * (record.position[i][axis] - x);
  }
  return tt > 0 ? tx / tt : 0;
}

/// Equal windows that fill a time from `begin` to `end`.
void divide(double begin, double end, double direction, std::vector<Window>& windows) {
  if (end - begin < kShortest) return;
  const double parts = std::ceil((end - begin) / kLongest);
  const double length = (end - begin) / parts;
  for (int i = 0; i < static_cast<int>(parts); ++i)
    windows.push_back({begin + i * length, begin + (i + 1) * length, direction});
}

}  // namespace

std::vector<double> smooth_velocity(const MotionRecord& record, std::size_t axis) {
  const auto n = static_cast<std::ptrdiff_t>(record.time.size());
  std::vector<double> velocity(record.time.size(), 0.0);
  for (std::ptrdiff_t i = kHalfWidth; i + kHalfWidth < n; ++i)
    velocity[static_cast<std::size_t>(i)] =
        slope_of(record, axis, static_cast<std::size_t>(i - kHalfWidth),
                 static_cast<std::size_t>(i + kHalfWidth));
  if (n <= 2 * kHalfWidth) return velocity;
  std::fill_n(velocity.begin(), kHalfWidth, velocity[kHalfWidth]);
  std::fill(velocity.end() - kHalfWidth, velocity.end(),
            velocity[static_cast<std::size_t>(n - kHalfWidth) - 1]);
  return velocity;
}

std::vector<Window> one_way_windows(const MotionRecord& record, double margin) {
  const std::vector<double> velocity = smooth_velocity(record, record.axis);
  std::vector<Window> windows;
  if (velocity.empty()) return windows;
  double largest = 0;
  for (const double v : velocity) largest = std::max(largest, std::abs(v));
  const double slow = kSlow * largest;
  const double start = record.time.front() + margin;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= velocity.size(); ++i) {
    const bool fast = std::abs(velocity[first]) > slow && record.time[first] >= start;
    const bool goes_on = i < velocity.size() && fast && std::abs(velocity[i]) > slow &&
                         velocity[i] * velocity[first] > 0;
    if (goes_on) continue;
    if (fast && i - first > 1)
      divide(record.time[first], record.time[i - 1], velocity[first] > 0 ? 1 : -1, windows);
    first = i;
  }
  return windows;
}

double TestFunction::value(double s, int derivative) const {
  if (s <= 0 || s >= 1) return 0;
  const double p = s * (1 - s), dp = 1 - 2 * s, p3 = p * p * p;
  switch (derivative) {
    case 0:
      return kPeak * p3 * p * p;
    case 1:
      return kPeak * 5 * p3 * p * dp / length();
    default:
      return kPeak * (20 * p3 * dp * dp - 10 * p3 * p) / (length() * length());
  }
}

double TestFunction::integral() const {
  return kPeak * length() / 2772;  // B(6, 6) = 1/2772
}

/// By the trapezoidal rule, which converges fast because the integrand vanishes smoothly at both
/// ends. The line between the first and the last position is integrated in closed form.
double TestFunction::integral_of(const MotionRecord& record, std::size_t axis,
                                 int derivative) const {
  const auto begin = std::lower_bound(record.time.begin(), record.time.end(), window_.begin);
  const auto end = std::upper_bound(record.time.begin(), record.time.end(), window_.end);
  const auto first = static_cast<std::size_t>(begin - record.time.begin());
  const auto last = static_cast<std::size_t>(end - record.time.begin()) - 1;
  const double x = record.position[first][axis], t = record.time[first];
  const double slope = (record.position[last][axis] - x) / (record.time[last] - t);
  const auto integrand = [&](std::size_t i) {
    return value((record.time[i] - window_.begin) / length(), derivative) *
           (record.position[i][axis] - x - slope * (record.time[i] - t));
  };
  double sum = 0;
  for (std::size_t i = first; i < last; ++i)
    sum += (integrand(i) + integrand(i + 1)) / 2 * (record.time[i + 1] - record.time[i]);
  // The mean of phi is at the middle of the window; phi' times t integrates to -phi, phi'' to zero.
  const double middle = x + slope * ((window_.begin + window_.end) / 2 - t);
  if (derivative == 0) return sum + middle * integral();
  return derivative == 1 ? sum - slope * integral() : sum;
}

double TestFunction::antiderivative(double time) const {
  const double s = std::clamp((time - window_.begin) / length(), 0.0, 1.0);
  const double s6 = s * s * s * s * s * s;
  return kPeak * length() * s6 *
         (1.0 / 6 + s * (-5.0 / 7 + s * (10.0 / 8 + s * (-10.0 / 9 + s * (5.0 / 10 - s / 11)))));
}

double TestFunction::integral_of_command(const MotionRecord& record, std::size_t axis,
                                         double delay) const {
  const auto reached =
      std::upper_bound(record.time.begin(), record.time.end(), window_.begin - delay);
  auto i = static_cast<std::size_t>(reached - record.time.begin());
  i = i > 0 ? i - 1 : 0;
  double sum = 0;
  for (; i < record.time.size() && record.time[i] + delay < window_.end; ++i) {
    const double from = record.time[i] + delay;
    const double to = i + 1 < record.time.size() ? record.time[i + 1] + delay : window_.end;
    sum += record.command[i][axis] * (antiderivative(to) - antiderivative(from));
  }
  return sum;
}

}  // namespace palpate::identify
