// SPDX-License-Identifier: AGPL-3.0-or-later
// The force that moves a device for its identification.
#pragma once

#include "format/vec3.hpp"

namespace palpate::identify {

struct ExcitationSettings {
  Vec3 direction{1, 0, 0};  ///< unit vector
  double max_force = 1;     ///< N
  double box = 0.02;        ///< m, distance from the start that is not left
  double seconds = 10;
};

/// Eight sines from 1.5 to 20 Hz along one direction, with amplitudes in proportion to their
/// frequency, so that low ones do not carry the tip away; in the last third of the time a square
/// wave, whose jumps show when a command acts. Its halves of 34 to 46 ms differ, so that they meet
/// every phase of what is periodic in the device. A weak spring to the start on every axis gives a
/// quarter of max_force at the border of the box.
/// The amplitude begins at zero, grows while the tip stays within half of the box (1.5 mm of the
/// last jump), and shrinks beyond; it fades out in the last half second of either part.
/// No component exceeds max_force. Allocation-free, noexcept; commands in the order of time.
class Excitation {
 public:
  explicit Excitation(const ExcitationSettings& settings) noexcept : settings_(settings) {}

  /// Force on the tool, N. @param time  s, from the first call on; @param x  m
  Vec3 command(double time, const Vec3& x) noexcept;
  bool left_box() const noexcept { return left_; }
  /// The last command reversed the square wave.
  bool jumped() const noexcept { return jumped_; }

 private:
  double sines(double time) const noexcept;
  double square(double time, double way) noexcept;
  void adapt(double time, double way) noexcept;

  ExcitationSettings settings_;
  bool begun_ = false, left_ = false, jumped_ = false;
  Vec3 start_{};
  double begin_ = 0, last_ = 0;  ///< s
  double gain_ = 0;              ///< of the wave, 0 to 1
  double sign_ = 0;              ///< of the square wave; 0 before it
  double next_jump_ = 0;         ///< s
  double centre_ = 0;            ///< m, along the direction, at the last jump
  int jumps_ = 0;
};

}  // namespace palpate::identify
