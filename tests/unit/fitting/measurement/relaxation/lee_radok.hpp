// SPDX-License-Identifier: AGPL-3.0-or-later
// A rigid sphere that is pressed into a viscoelastic half-space at a constant speed and then held
// [Lee & Radok 1960]: closed form, for the tests.
#pragma once

#include <cmath>
#include <vector>

#include "format/relaxation.hpp"

namespace palpate::calibrate {

struct RampAndHold {
  double peak = 1;                  ///< N, instantaneous force at the largest depth
  double depth = 1e-3, ramp = 0.2;  ///< m, s
  RelaxationSeries series;

  double travel(double t) const { return t < ramp ? depth * t / ramp : depth; }

  /// Dawson's integral D(x) = exp(-x^2) integral of exp(y^2) from 0 to x, by its series
  /// sum of (-1)^k 2^k x^(2k+1)/(2k+1)!! where that converges, else by its asymptotic expansion.
  static double dawson(double x) {
    if (x > 5) {
      const double q = 1 / (2 * x * x);
      return (1 + q * (1 + 3 * q * (1 + 5 * q * (1 + 7 * q * (1 + 9 * q))))) / (2 * x);
    }
    long double term = x, sum = x;
    for (int k = 1; k < 400; ++k) {
      term *= -2.0L * x * x / (2 * k + 1);
      sum += term;
    }
    return static_cast<double>(sum);
  }

  /// integral of exp(-(t - s)/tau) d(s/T)^1.5 from 0 to t, t <= T.
  double memory(double t, double tau) const {
    const double root = std::sqrt(t), q = std::sqrt(tau);
    return 1.5 * std::pow(ramp, -1.5) * (tau * root - tau * q * dawson(root / q));
  }

  double force(double t) const {
    const double within = std::min(t, ramp);
    double f = long_term_fraction(series) * std::pow(within / ramp, 1.5);
    for (const RelaxationBranch& b : series)
      f += b.fraction * memory(within, b.time_s) * std::exp(-(t - within) / b.time_s);
    return peak * f;
  }
};

inline std::vector<double> even_times(double end, std::size_t count) {
  std::vector<double> t;
  for (std::size_t i = 0; i < count; ++i)
    t.push_back(end * static_cast<double>(i) / static_cast<double>(count - 1));
  return t;
}

}  // namespace palpate::calibrate
