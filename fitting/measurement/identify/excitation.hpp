// SPDX-License-Identifier: AGPL-3.0-or-later
// The force that moves a device for its identification.
#pragma once

#include <cstddef>

#include "format/vec3.hpp"

namespace palpate::identify {

struct ExcitationSettings {
  std::size_t axis = 0;
  double max_force = 1;  ///< N
  double box = 0.02;     ///< m, distance from the start that is not left
  double seconds = 10;
};

/// Eight sines from 1.5 to 20 Hz along one axis, with amplitudes in proportion to their frequency,
/// so that low ones do not carry the tip away, and a weak spring to the start on every axis, which
/// gives a quarter of max_force at the border of the box. The amplitude begins at zero, grows while
/// the tip stays within half of the box, and shrinks beyond; it fades out in the last half second.
/// No component exceeds max_force. Allocation-free, noexcept; commands in the order of time.
class Excitation {
 public:
  explicit Excitation(const ExcitationSettings& settings) noexcept : settings_(settings) {}

  /// Force on the tool, N. @param time  s, from the first call on; @param x  m
  Vec3 command(double time, const Vec3& x) noexcept;
  bool left_box() const noexcept { return left_; }

 private:
  double sines(double time) const noexcept;
  void adapt(double time, double way) noexcept;

  ExcitationSettings settings_;
  bool begun_ = false, left_ = false;
  Vec3 start_{};
  double begin_ = 0, last_ = 0;  ///< s
  double gain_ = 0;              ///< of the sines, 0 to 1
};

}  // namespace palpate::identify
