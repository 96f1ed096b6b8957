// SPDX-License-Identifier: Apache-2.0
#include "format/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "format/error.hpp"

namespace palpate {
namespace {

/// Relative difference of two times that are one.
constexpr double kSameTime = 1e-9;

bool same_time(double a, double b) {
  return std::abs(a - b) <= kSameTime * std::max(a, b);
}

std::string text_of(const char* name, std::size_t branch, double value) {
  std::ostringstream text;
  text << "relaxation[" << branch << "]." << name << " = " << value;
  return text.str();
}

}  // namespace

double long_term_fraction(const RelaxationSeries& series) {
  double rest = 1;
  for (const RelaxationBranch& branch : series) rest -= branch.fraction;
  return rest;
}

double relaxed_fraction(const RelaxationSeries& series, double t) {
  double g = long_term_fraction(series);
  for (const RelaxationBranch& branch : series) g += branch.fraction * std::exp(-t / branch.time_s);
  return g;
}

void check_relaxation(const RelaxationSeries& series, const std::string& where) {
  double before = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const auto& [fraction, time] = series[i];
    if (!(fraction > 0 && fraction < 1))
      refuse(where, text_of("fraction", i, fraction) + " is out of range",
             "give a fraction between 0 and 1, both excluded");
    if (!(std::isfinite(time) && time > 0))
      refuse(where, text_of("time", i, time) + " s is out of range", "give a finite time above 0");
    if (time < before || same_time(time, before))
      refuse(where, text_of("time", i, time) + " s is not above the time before it",
             "give the branches in ascending order of time, each time once");
    before = time;
  }
  if (!(long_term_fraction(series) > 0)) {
    std::ostringstream sum;
    sum << "the fractions of relaxation sum to " << 1 - long_term_fraction(series);
    refuse(where, sum.str(),
           "give fractions with a sum below 1: the rest is the long-term modulus");
  }
}

RegionRelaxation over_one_list(const std::vector<RelaxationSeries>& series,
                               const std::string& where) {
  std::vector<double> times;
  for (const RelaxationSeries& one : series) {
    check_relaxation(one, where);
    for (const RelaxationBranch& branch : one) times.push_back(branch.time_s);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end(), same_time), times.end());
  RegionRelaxation merged{times, {}};
  for (const RelaxationSeries& one : series) {
    auto& fractions = merged.fractions.emplace_back(times.size(), 0.0);
    for (const RelaxationBranch& branch : one)
      for (std::size_t i = 0; i < times.size(); ++i)
        if (same_time(times[i], branch.time_s)) fractions[i] += branch.fraction;
  }
  return merged;
}

}  // namespace palpate
