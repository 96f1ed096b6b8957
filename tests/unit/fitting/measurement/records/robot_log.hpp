// SPDX-License-Identifier: AGPL-3.0-or-later
// The log of a synthetic robot that presses and drags a sphere on a flat body.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fitting/measurement/records/robot.hpp"
#include "tests/unit/fitting/measurement/records/bench.hpp"

namespace palpate::measured {

inline const Vec3 kInward{0, 0, -1};
inline const Bench kBench;
inline constexpr double kLateralStiffness = 55;  // N/m
inline constexpr double kSlipAt = 0.0022;        // m

/// A flat fan: vertex 0 in the middle of a hexagon of 12 mm, all in the plane z = 0.
inline Body plate() {
  Body body;
  body.name = "plate";
  body.nodes.push_back({0, 0, 0});
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3;
    body.nodes.push_back({0.012 * std::cos(angle), 0.012 * std::sin(angle), 0});
  }
  for (std::int32_t v = 0; v < 7; ++v) {
    body.response.node.push_back(v);
    body.response.inward.push_back(kInward);
    body.response.is_site.push_back(1);
  }
  return body;
}

struct Drag {
  double depth = 0.004, travel = 0.003;
  Vec3 direction{0.6, 0.8, 0};
  Vec3 touch{0.0006, -0.0004, 0};
  Vec3 sensor_offset{0.03, -0.05, 0.2};
  double noise = 0.001;
  bool drags = true;
  double stiffness = kLateralStiffness;
};

/// Approach over 2 mm, press to a depth, drag sideways: force without slip up to a limit, then
/// constant.
inline RobotLog log_of(const Drag& drag, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0, drag.noise);
  RobotLog log;
  log.name = "log";
  const double down = (0.002 + drag.depth) / kBench.speed, side = drag.travel / kBench.speed;
  for (int i = 0; i < static_cast<int>((down + (drag.drags ? side : 1)) * 50); ++i) {
    const double t = i / 50.0;
    const double depth = std::min(t, down) * kBench.speed - 0.002;
    const double s = drag.drags ? std::max(0.0, t - down) * kBench.speed : 0;
    const Vec3 jitter{noise(engine), noise(engine), noise(engine)};
    log.time.push_back(t);
    log.tip.push_back(drag.touch + depth * kInward + s * drag.direction);
    log.force.push_back(sneddon_force(depth, kBench.radius, kBench.modulus) * kInward +
                        drag.stiffness * std::min(s, kSlipAt) * drag.direction +
                        drag.sensor_offset + jitter);
  }
  return log;
}

}  // namespace palpate::measured
