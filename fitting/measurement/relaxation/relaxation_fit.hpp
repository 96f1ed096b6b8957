// SPDX-License-Identifier: AGPL-3.0-or-later
// A Prony series, and the elastic curve with it, from recorded histories of finite ramps.
// Theory: docs/theory-measured.md.
#pragma once

#include <string>
#include <vector>

#include "fitting/measurement/calibrate/least_squares.hpp"
#include "fitting/measurement/relaxation/relaxation_record.hpp"
#include "format/relaxation.hpp"

namespace palpate::calibrate {

/// The elastic (instantaneous) force over the travel d, x = d/d_max with d_max the largest travel
/// of all records.
enum class ElasticCurve {
  Power,     ///< F x^p
  TwoPowers  ///< F ((1 - w) x^p + w x^(p+1))
};

/// By which the number of terms is chosen.
enum class Criterion {
  Bic,  ///< [Schwarz 1978]
  Aicc  ///< [Hurvich & Tsai 1989]
};

struct RelaxationSettings {
  ElasticCurve curve = ElasticCurve::Power;
  double exponent = 1.5;      ///< p: its value, or its start
  bool fit_exponent = true;   ///< p is fitted as well
  int most_terms = 3;         ///< tried; at most 4
  int terms = 0;              ///< their number; 0: chosen by the criterion
  std::vector<double> times;  ///< s, ascending: a grid instead of free times; at most 4
  Criterion criterion = Criterion::Bic;
  double confidence = 0.95;
  bool profiles = false;  ///< intervals by profile likelihoods as well
};

/// A value with the ends of its interval; NaN ends where there is none.
struct Interval {
  double value = 0, low = 0, high = 0;
};

/// A number of terms that was tried.
struct TriedSeries {
  int terms = 0;
  double relative_rms = 0;  ///< of the residuals, over the largest force or travel
  double aicc = 0, bic = 0;
  std::string refused;  ///< why it is not taken; empty: it could be
};

struct FittedRecord {
  std::string name;
  Interval instantaneous;  ///< N, elastic force at the largest travel of all records
  Interval long_term;      ///< N, that when all has relaxed
  double rms = 0;          ///< N, or m where the force is held
  double relative_rms = 0;
  std::vector<double> fitted;  ///< N at each sample, or m where the force is held
};

/// g at a time with its interval.
struct BandPoint {
  double time = 0;  ///< s
  Interval g;
};

struct RelaxationFit {
  /// Constants: force_1, ... (N), exponent, second_power, then fraction_i and time_i (s).
  Calibration calibration;
  RelaxationSeries series;  ///< without terms that vanish
  Interval long_term_fraction;
  double exponent = 0, second_power = 0, largest_travel = 0;  ///< p, w, d_max in m
  std::vector<TriedSeries> tried;
  std::vector<FittedRecord> records;
  std::vector<BandPoint> band;
  /// s: the records show what relaxes in times between these, and nothing of others.
  double shortest = 0, longest = 0;
};

/// Least squares of the hereditary integral (hereditary.hpp) through all records, with one series
/// and one shape of the elastic curve; each record has its own force. Where the force is held the
/// travel is predicted, by the Volterra equation. Residuals are over the largest force (or travel)
/// of the record. Fractions are not negative and sum to less than 1. Times are sought from a
/// fiftieth of the shortest ramp, or two samples, to three times the longest record, as
/// logarithms.
/// Terms are added while the criterion falls. It has the likelihood of noise whose neighbours are
/// correlated, with the correlation that makes it largest. A series with a fraction at 0, a time at
/// a bound, or two times within a fifth of each other is not taken.
/// Intervals are those of least_squares.hpp, those of derived numbers by the delta method. Warned
/// of: times shorter than a tenth of the ramp, or two samples, or longer than the record, times
/// whose interval spans a factor of four, and what else minimise() warns of.
/// @throws Error(Configuration) for no record, settings out of range, records that do not relax,
///   and fits that do not converge.
RelaxationFit fit_relaxation(const std::vector<RelaxationRecord>& records,
                             const RelaxationSettings& settings);

}  // namespace palpate::calibrate
