// SPDX-License-Identifier: AGPL-3.0-or-later
// The hereditary integral of quasi-linear viscoelasticity [Fung 1981, sec. 7.6] over a recorded
// history,
//   f(t) = integral of g(t - s) de(s),   g(t) = g_inf + sum of g_i exp(-t/tau_i),
// with e the elastic (instantaneous) force, and its inverse, a Volterra equation for e.
// Theory: docs/theory-measured.md.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace palpate::calibrate {

/// A Prony series in a number type of its own, so that it can be differentiated.
template <class T>
struct PronySeries {
  std::vector<T> fraction;  ///< g_i; g_inf = 1 - sum of g_i
  std::vector<T> time;      ///< tau_i, s

  T long_term() const {
    T rest(1);
    for (const T& g : fraction) rest -= g;
    return rest;
  }
};

/// One term over one interval h of time in which e is linear: its memory m = integral of
/// g_i exp(-(t - s)/tau_i) de(s) becomes decay m + gain (e_n - e_n-1).
template <class T>
struct TermStep {
  T decay, gain;

  TermStep(const T& fraction, const T& time, double h) {
    using std::exp;
    using std::expm1;
    const T x = T(h) / time;
    decay = exp(-x);
    // (1 - exp(-x))/x loses its digits for small x.
    gain = fraction * (x < T(1e-5) ? T(1) - 0.5 * x : (T(1) - decay) / x);
  }
};

/// The steps of all terms over intervals of time, made anew only where the interval changes.
template <class T>
class SeriesSteps {
 public:
  explicit SeriesSteps(const PronySeries<T>& series) : series_(series) {}

  const std::vector<TermStep<T>>& over(double h) {
    if (steps_.empty() || std::abs(h - h_) > 1e-12 * h_) {
      h_ = h;
      steps_.clear();
      for (std::size_t i = 0; i < series_.time.size(); ++i)
        steps_.emplace_back(series_.fraction[i], series_.time[i], h);
    }
    return steps_;
  }

 private:
  const PronySeries<T>& series_;
  std::vector<TermStep<T>> steps_;
  double h_ = 0;
};

/// f at each time, N, of elastic forces e that are linear between the times, N. Before the first
/// time all is at rest; a force there is a step. Exact, in a time proportional to samples and
/// terms. @param time  s, strictly increasing.
template <class T>
std::vector<T> hereditary_force(const std::vector<double>& time, const std::vector<T>& elastic,
                                const PronySeries<T>& series) {
  const std::size_t terms = series.time.size();
  const T rest = series.long_term();
  std::vector<T> force, memory;
  force.reserve(time.size());
  for (std::size_t i = 0; i < terms; ++i) memory.push_back(series.fraction[i] * elastic.front());
  SeriesSteps<T> steps(series);
  for (std::size_t n = 0; n < time.size(); ++n) {
    T sum = rest * elastic[n];
    if (n > 0) {
      const auto& step = steps.over(time[n] - time[n - 1]);
      const T risen = elastic[n] - elastic[n - 1];
      for (std::size_t i = 0; i < terms; ++i)
        memory[i] = step[i].decay * memory[i] + step[i].gain * risen;
    }
    for (const T& m : memory) sum += m;
    force.push_back(sum);
  }
  return force;
}

/// e at each time, N, of given forces: the inverse of hereditary_force, step by step in closed
/// form, with e linear between the times. @param time  s, strictly increasing.
template <class T>
std::vector<T> elastic_force(const std::vector<double>& time, const std::vector<double>& force,
                             const PronySeries<T>& series) {
  const std::size_t terms = series.time.size();
  const T rest = series.long_term();
  std::vector<T> elastic{T(force.front())}, memory;
  elastic.reserve(time.size());
  for (std::size_t i = 0; i < terms; ++i) memory.push_back(series.fraction[i] * force.front());
  SeriesSteps<T> steps(series);
  for (std::size_t n = 1; n < time.size(); ++n) {
    const auto& step = steps.over(time[n] - time[n - 1]);
    T known(force[n]), factor = rest;
    for (std::size_t i = 0; i < terms; ++i) {
      known -= step[i].decay * memory[i] - step[i].gain * elastic.back();
      factor += step[i].gain;
    }
    const T e = known / factor;
    for (std::size_t i = 0; i < terms; ++i)
      memory[i] = step[i].decay * memory[i] + step[i].gain * (e - elastic.back());
    elastic.push_back(e);
  }
  return elastic;
}

}  // namespace palpate::calibrate
