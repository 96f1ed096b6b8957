// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/relaxation/before_relaxing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "fitting/measurement/relaxation/hereditary.hpp"
#include "format/error.hpp"

namespace palpate::measured {

namespace {

constexpr double kPause = 3;  // a pause is longer than so many of the usual intervals

/// s, between samples
double usual_interval(const std::vector<DepthForce>& branch) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < branch.size(); ++i)
    intervals.push_back(branch[i].time - branch[i - 1].time);
  std::sort(intervals.begin(), intervals.end());
  return intervals.empty() ? 0 : intervals[intervals.size() / 2];
}

/// What the branch remembers, and its instantaneous force.
class Memory {
 public:
  Memory(const RelaxationSeries& series, double first) : elastic_(first) {
    for (const RelaxationBranch& branch : series) {
      series_.fraction.push_back(branch.fraction);
      series_.time.push_back(branch.time_s);
      memory_.push_back(branch.fraction * first);
    }
  }

  void hold(double time) {
    for (std::size_t i = 0; i < memory_.size(); ++i)
      memory_[i] *= std::exp(-time / series_.time[i]);
  }

  /// The instantaneous force after an interval in which it changes linearly, by the force there.
  double move(double interval, double force) {
    double known = force, factor = series_.long_term();
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      const calibrate::TermStep<double> step(series_.fraction[i], series_.time[i], interval);
      memory_[i] = step.decay * memory_[i] - step.gain * elastic_;
      known -= memory_[i];
      factor += step.gain;
    }
    elastic_ = known / factor;
    for (std::size_t i = 0; i < memory_.size(); ++i)
      memory_[i] +=
          calibrate::TermStep<double>(series_.fraction[i], series_.time[i], interval).gain *
          elastic_;
    return elastic_;
  }

 private:
  calibrate::PronySeries<double> series_;
  std::vector<double> memory_;
  double elastic_;
};

}  // namespace

PressCurve before_relaxing(PressCurve press, const RelaxationSeries& series,
                           const std::string& where) {
  if (!std::isfinite(press.rate)) {
    throw Error(ErrorKind::Configuration, where,
                "how much relaxes during the press depends on its time, which it lacks",
                "name the column of the time, or leave out path.relaxation");
  }
  const double usual = usual_interval(press.loading);
  Memory memory(series, press.loading.front().force);
  double last = press.loading.front().time;
  for (std::size_t i = 1; i < press.loading.size(); ++i) {
    DepthForce& sample = press.loading[i];
    double interval = sample.time - last;
    if (interval > kPause * usual) {
      memory.hold(interval - usual);
      interval = usual;
    }
    last = sample.time;
    sample.force = memory.move(interval, sample.force);
  }
  return press;
}

void let_relax(SiteCurves& site) {
  for (CurvePath& path : site.paths) {
    for (CurveSample& sample : path.samples) {
      sample.strain_energy = sample.tool_work;
      sample.isochoric_energy = {sample.strain_energy};
    }
  }
}

}  // namespace palpate::measured
