// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "app/case/case.hpp"
#include "app/simulate/surface_path.hpp"

namespace palpate::app {

/// Position and velocity of the hand.
struct HandState {
  Vec3 position{};  ///< m
  Vec3 velocity{};  ///< m/s
};

/// Peak of the speed along each part of the path over its mean.
inline constexpr double kPeakOverMean = 1.5;

/// The scripted path of the hand: from above the surface, as high as the press is deep, down to the
/// press depth, a rest, along the surface at that depth, and up again. Each part starts and ends at
/// rest; the speed of the script is its peak.
class HandPath {
 public:
  /// @pre nothing that the path needs is `auto` in the script.
  HandPath(const SimulateSection& script, std::vector<PathPoint> path);

  double duration() const { return hold_end_ + slide_time_ + press_end_; }  ///< s
  HandState at(double time) const;

 private:
  Vec3 position(double time) const;

  SimulateSection script_;
  std::vector<PathPoint> path_;
  double press_end_;   ///< s, time of the press, and of the release
  double hold_end_;    ///< s
  double slide_time_;  ///< s
};

}  // namespace palpate::app
