// SPDX-License-Identifier: AGPL-3.0-or-later
// Records of tests whose solution is known in closed form, with noise.
#pragma once

#include <random>

#include "fitting/measurement/relaxation/relaxation_record.hpp"
#include "tests/unit/fitting/measurement/relaxation/lee_radok.hpp"

namespace palpate::calibrate {

struct RecordNoise {
  double deviation = 0;    ///< over the largest value
  double correlation = 0;  ///< of neighbouring samples
  unsigned seed = 1;
};

/// Adds noise of that deviation and correlation.
inline void disturb(std::vector<double>& values, double scale, const RecordNoise& noise) {
  std::mt19937 engine(noise.seed);
  std::normal_distribution<double> normal;
  const double fresh = std::sqrt(1 - noise.correlation * noise.correlation);
  double e = normal(engine);
  for (double& value : values) {
    value += scale * noise.deviation * e;
    e = noise.correlation * e + fresh * normal(engine);
  }
}

inline RelaxationRecord record_on(const RampAndHold& sphere, double end, std::size_t count,
                                  const RecordNoise& noise) {
  RelaxationRecord record;
  record.name = "sphere";
  record.ramp = sphere.ramp;
  record.time = even_times(end, count);
  for (const double t : record.time) {
    record.travel.push_back(sphere.travel(t));
    record.force.push_back(sphere.force(t));
  }
  disturb(record.force, sphere.peak, noise);
  return record;
}

/// A force that grows for a second and is held, on a standard linear solid under a flat punch (e is
/// the travel times 2 N/mm): the travel by the creep compliance
/// J(t) = 1/g_inf - (1/g_inf - 1) exp(-t/T), T = tau/g_inf [Findley, Lai & Onaran 1976].
inline RelaxationRecord creep_record(const RelaxationSeries& solid, const RecordNoise& noise) {
  constexpr double kRamp = 1, kPeak = 1;
  const double rest = long_term_fraction(solid), late = solid.front().time_s / rest;
  // integral of J from 0 to t, over the ramp
  const auto risen = [&](double t) {
    return t / rest - (1 / rest - 1) * late * (1 - std::exp(-t / late));
  };
  RelaxationRecord record;
  record.name = "creep";
  record.force_is_held = true;
  record.ramp = kRamp;
  record.time = even_times(20, 1000);
  for (const double t : record.time) {
    record.force.push_back(kPeak * std::min(t / kRamp, 1.0));
    const double e = kPeak / kRamp * (risen(t) - (t > kRamp ? risen(t - kRamp) : 0));
    record.travel.push_back(0.5e-3 * e);
  }
  disturb(record.travel, record.travel.back(), noise);
  for (double& x : record.travel) x = std::max(0.0, x);
  return record;
}

}  // namespace palpate::calibrate
