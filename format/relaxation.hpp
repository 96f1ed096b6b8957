// SPDX-License-Identifier: Apache-2.0
// Prony series of tissue that relaxes: g(t) = g_inf + sum of g_i exp(-t/tau_i), g_inf + sum of
// g_i = 1. Only the isochoric stress relaxes; the volumetric one is elastic.
#pragma once

#include <string>
#include <vector>

namespace palpate {

/// A term of a Prony series.
struct RelaxationBranch {
  double fraction = 0;  ///< g_i, of the instantaneous isochoric stress
  double time_s = 0;    ///< tau_i, s

  bool operator==(const RelaxationBranch&) const = default;
};

/// The terms of a material in ascending order of time. Empty: elastic.
using RelaxationSeries = std::vector<RelaxationBranch>;

/// g_inf = 1 - sum of g_i.
double long_term_fraction(const RelaxationSeries& series);

/// g(t), of the instantaneous isochoric stress, at a time t >= 0 in s after a step of strain.
double relaxed_fraction(const RelaxationSeries& series, double t);

/// @throws Error(Configuration), named after `where`, unless every fraction is positive, their sum
/// is below 1, and the times are positive, finite and ascending.
void check_relaxation(const RelaxationSeries& series, const std::string& where);

/// The series of the regions of a body over one list of times.
struct RegionRelaxation {
  std::vector<double> times_s;                 ///< ascending; empty: every region is elastic
  std::vector<std::vector<double>> fractions;  ///< [region][time]; 0 where the region lacks it

  bool empty() const { return times_s.empty(); }
  bool operator==(const RegionRelaxation&) const = default;
};

/// `series`: one for each region. The times are their union; two that differ by less than 1e-9 of
/// their value are one. @throws Error(Configuration) as check_relaxation.
RegionRelaxation over_one_list(const std::vector<RelaxationSeries>& series,
                               const std::string& where);

}  // namespace palpate
