// SPDX-License-Identifier: AGPL-3.0-or-later
// Baseline and contact point of a press, estimated together, and what is uncertain about them.
// Theory: docs/theory-measured.md.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace palpate::measured {

/// Samples of a press, in order of time.
struct OnsetSamples {
  std::vector<double> time;            ///< s; empty: unknown
  std::vector<double> displacement;    ///< m, less what the machine yields
  std::vector<double> force;           ///< N, as recorded
  std::vector<char> free;              ///< 1: out of contact, whatever the displacement
  std::vector<std::size_t> stretches;  ///< lengths of the runs of consecutive samples

  std::size_t size() const { return force.size(); }
};

/// Baseline and contact point.
struct OnsetEstimate {
  double offset = 0;                                  ///< N, at time 0
  double drift = 0;                                   ///< N/s
  double contact = 0;                                 ///< m
  std::array<std::array<double, 3>, 3> covariance{};  ///< of the three
  double noise = 0;                                   ///< N, standard deviation of one sample
  double autocorrelation = 0;                         ///< of neighbouring samples
};

struct OnsetModel {
  double exponent = 1.5;  ///< p
  bool offset = true;     ///< a is an unknown; otherwise it is 0, and so is b
  bool drift = false;     ///< b is an unknown; otherwise it is 0
};

/// Least squares of
///   f = a + b t + a1 z^p + a2 z^(p+1),   z = max(0, x - c), 0 where free,   a1 >= 0,
/// over c, a1, a2 and, as the model says, a and b; the second power is for what bends the curve
/// later (size of the tool, large strain, thickness). c by a scan from the first displacement that
/// is not free, the other unknowns by linear algebra; covariance of the linearised model by
/// estimate_errors.
OnsetEstimate fit_onset(const OnsetSamples& samples, const OnsetModel& model);

/// Least squares line a + b t (with `drift`), or mean, through the forces of samples all of which
/// are free. The contact point is not estimated.
OnsetEstimate fit_baseline(const OnsetSamples& samples, bool drift);

/// Whether a parabola through the forces of samples all of which are free is no better than a line,
/// but for what chance gives one time in a hundred. False for fewer than six samples.
bool is_straight(const OnsetSamples& samples);

}  // namespace palpate::measured
