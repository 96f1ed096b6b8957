// SPDX-License-Identifier: AGPL-3.0-or-later
// The equation of motion along one axis, integrated so that no position is differentiated.
#pragma once

#include <cstddef>
#include <vector>

#include "fitting/measurement/identify/motion_record.hpp"

namespace palpate::identify {

/// A time during which the tip moves one way along the axis.
struct Window {
  double begin = 0, end = 0;  ///< s
  double direction = 1;       ///< sign of the velocity
};

/// Windows of at most 60 ms and at least 15 ms in which the speed along the excited axis, of the
/// slope of a line through 11 samples, is above a twentieth of its largest value. Those within
/// `margin` (s) of the beginning of the record are left out, as the commands before it are not
/// known.
std::vector<Window> one_way_windows(const MotionRecord& record, double margin);

/// Slope of the line through the samples i - 5 .. i + 5 of the positions along `axis`, m/s, one for
/// each sample; the first and the last five repeat their neighbour.
std::vector<double> smooth_velocity(const MotionRecord& record, std::size_t axis);

/// phi(s) = 64 s^3 (1 - s)^3 on a window, s from 0 to 1: it vanishes at both ends with its first
/// and second derivative, so that the integrals of phi x'' and phi x' are those of phi'' x and
/// -phi' x.
class TestFunction {
 public:
  explicit TestFunction(const Window& window) : window_(window) {}

  double integral() const;                                                   ///< of phi, s
  double integral_until(double time) const { return antiderivative(time); }  ///< of phi, s
  double integral_of(const MotionRecord& record, std::size_t axis, int derivative) const;
  /// Integral of phi times the command along `axis` that acts `delay` (s) after its sample was
  /// read.
  double integral_of_command(const MotionRecord& record, std::size_t axis, double delay) const;

 private:
  double length() const { return window_.end - window_.begin; }
  double value(double s, int derivative) const;
  double antiderivative(double time) const;

  Window window_;
};

}  // namespace palpate::identify
