// SPDX-License-Identifier: AGPL-3.0-or-later
// A device whose constants are known, moved by the excitation of the identification.
#pragma once

#include <cmath>
#include <random>

#include "fitting/measurement/identify/excitation.hpp"
#include "fitting/measurement/identify/motion_record.hpp"
#include "runtime/devices/device_simulated.hpp"

namespace palpate::samples {

struct MovedDevice {
  Vec3 mass{0.1, 0.1, 0.1}, damping{0.1, 0.1, 0.1}, friction{0.02, 0.02, 0.02};
  Vec3 bias{};            ///< N: weight
  double delay = 1e-3;    ///< s, from a sample to the force that follows it
  double resolution = 0;  ///< m
  double jitter = 0;      ///< s, of the times of the samples
  double noise = 0;       ///< N, standard deviation of a hand that trembles
  double rate = 1000;     ///< Hz
  double seconds = 10;
  double max_force = 1, box = 0.02;
  unsigned seed = 1;
};

/// Record of an excitation along one axis. The motion is that of the exact simulation in twenty
/// steps a period; the command reaches the device after the delay.
inline identify::MotionRecord moved(const MovedDevice& d, std::size_t axis) {
  using identify::Excitation;
  identify::MotionRecord record;
  record.axis = axis;
  // One simulated device an axis: their constants differ.
  std::array<runtime::SimulatedDevice, 3> axes{
      runtime::SimulatedDevice({d.mass[0], d.damping[0], d.friction[0], 0, 0, 0}),
      runtime::SimulatedDevice({d.mass[1], d.damping[1], d.friction[1], 0, 0, 0}),
      runtime::SimulatedDevice({d.mass[2], d.damping[2], d.friction[2], 0, 0, 0})};
  Excitation excitation({axis, d.max_force, d.box, d.seconds});
  std::mt19937 random(d.seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  constexpr int kFine = 20;
  const double period = 1 / d.rate, fine = period / kFine;
  const auto samples = static_cast<std::size_t>(d.seconds * d.rate);
  double tremble = 0;
  std::size_t acting = 0;  // one more than the row of the command that acts
  double next_sample = 0;
  for (long i = 0; record.time.size() < samples; ++i) {
    const double now = static_cast<double>(i) * fine;
    if (now >= next_sample - 1e-12) {
      Vec3 x{};
      for (std::size_t a = 0; a < 3; ++a) {
        x[a] = axes[a].position()[a];
        if (d.resolution > 0) x[a] = d.resolution * std::round(x[a] / d.resolution);
      }
      record.time.push_back(now);
      record.position.push_back(x);
      record.command.push_back(excitation.command(now, x));
      const double shift = d.jitter * uniform(random);
      next_sample =
          fine * std::round((static_cast<double>(record.time.size()) * period + shift) / fine);
      tremble = 0.99 * tremble + d.noise * std::sqrt(1 - 0.99 * 0.99) * normal(random);
    }
    while (acting < record.time.size() && record.time[acting] + d.delay <= now + 1e-12) ++acting;
    const Vec3 command = acting > 0 ? record.command[acting - 1] : Vec3{};
    for (std::size_t a = 0; a < 3; ++a) {
      Vec3 force{};
      force[a] = command[a] - d.bias[a] + tremble;
      axes[a].step(fine, force);
    }
  }
  return record;
}

}  // namespace palpate::samples
