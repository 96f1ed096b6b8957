// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/simulate/hand_path.hpp"

#include <algorithm>
#include <utility>

namespace palpate::app {
namespace {

/// From 0 to 1 with rest at both ends.
double smooth(double fraction) {
  const double s = std::clamp(fraction, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

}  // namespace

HandPath::HandPath(const SimulateSection& script, std::vector<PathPoint> path)
    : script_(script),
      path_(std::move(path)),
      press_end_(kPeakOverMean * 2 * script.press_depth / script.press_speed),
      hold_end_(press_end_ + script.hold),
      slide_time_(kPeakOverMean * path_.back().distance / script.slide_speed) {}

Vec3 HandPath::position(double time) const {
  const double release = time - hold_end_ - slide_time_;
  const double pressed = smooth(time / press_end_) - smooth(release / press_end_);
  const double slid = slide_time_ > 0 ? smooth((time - hold_end_) / slide_time_) : 0;
  const PathPoint point = point_at(path_, slid * path_.back().distance);
  const double depth = (2 * pressed - 1) * script_.press_depth;
  return point.position + depth * point.inward;
}

HandState HandPath::at(double time) const {
  constexpr double step = 1e-5;  // s; the path has kinks, so its slope is taken over a short time
  return {position(time), (1 / (2 * step)) * (position(time + step) - position(time - step))};
}

}  // namespace palpate::app
