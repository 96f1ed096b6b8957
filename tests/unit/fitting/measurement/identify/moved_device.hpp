// SPDX-License-Identifier: AGPL-3.0-or-later
// A device whose constants are known, moved by the excitation of the identification.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <random>

#include "fitting/measurement/identify/directions.hpp"
#include "fitting/measurement/identify/excitation.hpp"
#include "fitting/measurement/identify/motion_record.hpp"
#include "runtime/devices/device_simulated.hpp"

namespace palpate::samples {

/// s, of delays that an identification looks for.
inline constexpr double kLargestDelay = 0.03;

struct MovedDevice {
  Vec3 mass{0.1, 0.1, 0.1}, damping{0.1, 0.1, 0.1}, friction{0.02, 0.02, 0.02};  ///< of each joint
  identify::Frame joints{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< directions in which they move
  Vec3 bias{};                                                ///< N, of each joint: weight
  double delay = 1e-3;      ///< s, from a sample to the force that follows it: the smallest
  double delay_spread = 0;  ///< s, equally distributed
  double lateness = 0;      ///< s, age of a position when it is reported, from 0 to this
  double resolution = 0;    ///< m
  double jitter = 0;        ///< s, of the times of the samples
  double noise = 0;         ///< N, standard deviation of a hand that trembles
  double rate = 1000;       ///< Hz
  double seconds = 15;
  double max_force = 1, box = 0.02;
  unsigned seed = 1;
};

/// The joints, the commands on their way, and the positions that a late report shows.
class MovedJoints {
 public:
  static constexpr int kFine = 20;  ///< steps of the exact simulation a period

  explicit MovedJoints(const MovedDevice& d)
      : d_(d), joints_{joint(0), joint(1), joint(2)}, random_(d.seed) {}

  double fine() const { return 1 / d_.rate / kFine; }  ///< s
  double shift() { return d_.jitter * between(-1, 1); }

  /// The reported position, which is some time old.
  Vec3 report() {
    const double steps = std::floor(d_.lateness * between(0, 1) / fine());
    const auto age = std::min(past_.size() - 1, static_cast<std::size_t>(steps));
    Vec3 x = past_[age];
    if (d_.resolution > 0)
      for (double& component : x) component = d_.resolution * std::round(component / d_.resolution);
    return x;
  }

  void send(double now, const Vec3& command) {
    const double arrival = now + d_.delay + d_.delay_spread * between(0, 1);
    coming_.push_back({arrival, command});
    tremble_ = 0.99 * tremble_ + d_.noise * std::sqrt(1 - 0.99 * 0.99) * normal_(random_);
  }

  void advance(double now) {
    for (; !coming_.empty() && coming_.front().time <= now + 1e-12; coming_.pop_front())
      acting_ = coming_.front().command;
    Vec3 x{};
    for (std::size_t j = 0; j < 3; ++j) {
      const double force = dot(d_.joints[j], acting_) - d_.bias[j] + tremble_;
      joints_[j].step(fine(), {force, 0, 0});
      x = x + joints_[j].position()[0] * d_.joints[j];
    }
    past_.push_front(x);
    if (past_.size() > 400) past_.pop_back();
  }

 private:
  struct Coming {
    double time = 0;
    Vec3 command{};
  };

  runtime::SimulatedDevice joint(std::size_t j) const {
    return runtime::SimulatedDevice({d_.mass[j], d_.damping[j], d_.friction[j], 0, 0, 0});
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  MovedDevice d_;
  std::array<runtime::SimulatedDevice, 3> joints_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::deque<Coming> coming_;
  std::deque<Vec3> past_{Vec3{}};  ///< newest first
  Vec3 acting_{};
  double tremble_ = 0;
};

/// Record of an excitation along a direction, in the frame whose first axis it is.
inline identify::MotionRecord moved_along(const MovedDevice& d, const Vec3& direction) {
  identify::MotionRecord record;
  MovedJoints joints(d);
  identify::Excitation excitation({direction, d.max_force, d.box, d.seconds});
  const identify::Frame frame = identify::frame_along(direction);
  const double fine = joints.fine();
  const auto samples = static_cast<std::size_t>(d.seconds * d.rate);
  double next_sample = 0;
  for (long i = 0; record.time.size() < samples; ++i) {
    const double now = static_cast<double>(i) * fine;
    if (now >= next_sample - 1e-12) {
      const Vec3 x = joints.report(), command = excitation.command(now, x);
      if (excitation.jumped()) record.jump.push_back(record.time.size());
      record.time.push_back(now);
      record.position.push_back(identify::in_frame(frame, x));
      record.command.push_back(identify::in_frame(frame, command));
      joints.send(now, command);
      const double due = static_cast<double>(record.time.size()) / d.rate + joints.shift();
      next_sample = fine * std::round(due / fine);
    }
    joints.advance(now);
  }
  return record;
}

/// The same along an axis.
inline identify::MotionRecord moved(const MovedDevice& d, std::size_t axis) {
  Vec3 direction{};
  direction[axis] = 1;
  return moved_along(d, direction);
}

}  // namespace palpate::samples
