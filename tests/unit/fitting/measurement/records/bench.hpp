// SPDX-License-Identifier: AGPL-3.0-or-later
// A synthetic testing machine: what it would record of a sphere pressed into a half space.
#pragma once

#include <cmath>
#include <random>

#include "fitting/measurement/records/press.hpp"

namespace palpate::measured {

/// Force on a rigid sphere of radius R at a depth, by the contact radius a [Sneddon 1965]:
///   F = E*/2 [(a^2 + R^2) ln((R + a)/(R - a)) - 2 a R],  depth = a/2 ln((R + a)/(R - a)).
inline double sneddon_force(double depth, double radius, double modulus) {
  if (depth <= 0) return 0;
  double low = 0, high = radius * (1 - 1e-12);
  for (int i = 0; i < 100; ++i) {
    const double a = 0.5 * (low + high);
    (0.5 * a * std::log((radius + a) / (radius - a)) < depth ? low : high) = a;
  }
  const double a = 0.5 * (low + high);
  return 0.5 * modulus *
         ((a * a + radius * radius) * std::log((radius + a) / (radius - a)) - 2 * a * radius);
}

/// The truth behind a synthetic record, to compare the analysis with.
struct Bench {
  double contact = 0.0023;  ///< m, of the specimen, in machine coordinates without compliance
  double modulus = 30e3;    ///< Pa, E* = E/(1 - nu^2)
  double radius = 0.005;    ///< m
  double depth = 0.004;     ///< m, into the specimen
  double compliance = 0;    ///< m/N
  double offset = 0.12;     ///< N, of the load cell
  double drift = 0;         ///< N/s
  double noise = 0.001;     ///< N
  double speed = 0.001;     ///< m/s
  double rate = 50;         ///< samples a second
  double loss = 0.8;        ///< force of the unloading branch over the loading one
  double hold = 0;          ///< s at the deepest point
  int presses = 1;
};

/// The record of a constant speed of the specimen's surface: in, hold, out; displacement as the
/// machine shows it, with the yielding of its frame.
inline PressRecord press_on(const Bench& bench, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0, bench.noise);
  PressRecord record;
  record.name = "bench";
  const double last = bench.contact + bench.depth, leg = last / bench.speed;
  const double period = 2 * leg + bench.hold;
  for (int i = 0; i < static_cast<int>(bench.presses * period * bench.rate); ++i) {
    const double t = i / bench.rate, phase = std::fmod(t, period);
    const bool back = phase > leg + bench.hold;
    const double x = phase < leg ? bench.speed * phase
                     : back      ? last - bench.speed * (phase - leg - bench.hold)
                                 : last;
    const double f =
        sneddon_force(x - bench.contact, bench.radius, bench.modulus) * (back ? bench.loss : 1.0);
    record.time.push_back(t);
    record.displacement.push_back(x + bench.compliance * f);
    record.force.push_back(f + bench.offset + bench.drift * t + noise(engine));
  }
  return record;
}

}  // namespace palpate::measured
