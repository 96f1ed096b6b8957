// SPDX-License-Identifier: AGPL-3.0-or-later
// One press of a testing machine: from displacement and force over time to force over depth, with
// what is uncertain about it. Theory and tests: docs/theory-measured.md.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fitting/measurement/records/onset.hpp"
#include "fitting/measurement/records/saturation.hpp"
#include "format/numbers.hpp"

namespace palpate::measured {

/// What a machine recorded of one press, in SI. `time` may be empty: drift and rate are unknown
/// then. Displacement grows into the body, force is positive in compression.
struct PressRecord {
  std::string name;  ///< for messages
  std::vector<double> time;
  std::vector<double> displacement;
  std::vector<double> force;
  /// N, readings of the channels of the load cell, where the force is made of several; else empty.
  std::vector<std::vector<double>> channels;
};

enum class ContactMethod {
  Fit,        ///< least squares of the onset, see fit_onset
  Threshold,  ///< the last crossing of a force, corrected by nothing: biased, for comparison
  Given       ///< known beforehand
};

enum class BaselineMethod {
  Fit,    ///< from the samples out of contact
  Zeroed  ///< the force is zero out of contact, as recorded
};

struct PressSettings {
  double compliance = 0;              ///< m/N, of machine and load cell
  double compliance_uncertainty = 0;  ///< m/N, standard
  int cycle = 1;                      ///< which press of the record; -1 is the last
  double exponent = 1.5;              ///< of the onset: 1.5 sphere, 1 flat punch, 2 cone
  ContactMethod method = ContactMethod::Fit;
  double threshold = 0;            ///< N, Threshold only
  double contact = 0;              ///< m, displacement at the contact point, Given only
  double contact_uncertainty = 0;  ///< m, standard, Given only
  BaselineMethod baseline = BaselineMethod::Fit;
  double zero_uncertainty = 0;  ///< N, standard, of the zero of the force, Zeroed only
};

/// What a record says about the drift of its force.
enum class DriftState {
  Unknown,       ///< nothing: it has no time, or too few samples out of contact
  Fitted,        ///< it determines the drift, which is removed
  Undetermined,  ///< it shows none, and would not show one that matters; none is removed
  Suspected      ///< it shows one that it does not determine; none is removed, it is in u
};

/// Force before contact: force = offset + drift (t - start).
struct Baseline {
  double offset = 0;                    ///< N
  double start = 0;                     ///< s
  double drift = 0;                     ///< N/s; 0 unless Fitted
  double drift_uncertainty = kUnknown;  ///< N/s, standard
  double noise = 0;                     ///< N, standard deviation of one sample
  double autocorrelation = 0;           ///< of neighbouring samples, of that noise
  DriftState state = DriftState::Unknown;
  /// N/s: the samples out of contact do not exclude a drift of that size (95 %); Undetermined and
  /// Suspected only.
  double possible_drift = kUnknown;
};

struct ContactPoint {
  double displacement = 0;  ///< m, of the machine, corrected for compliance
  double uncertainty = 0;   ///< m, standard: noise and choice of the fitted range
};

/// Baseline and contact point are errors that all samples of a press have in common.
struct CommonErrors {
  std::array<OnsetEstimate, 3> estimates;  ///< by the fitted range; the middle one is used
  double compliance = 0;                   ///< m/N
  double suspected_drift = 0;              ///< N/s (or N a sample), not removed
  double suspected_from = 0;               ///< s, mean time of the samples of the baseline

  /// Variance of v = h . (offset, drift, contact): with S the covariance of the three,
  ///   h . S h + (spread^2 - chance)/12,
  /// spread that of v between the ranges, chance what is expected of it without any misfit, the
  /// difference of the variances of the smallest and the largest range [Hausman 1978].
  double variance_of(const std::array<double, 3>& h) const;

  /// N^2, what they add to the force at a depth, where the slope is k and time t after the start of
  /// the press: variance_of(h) + ((1 + k C) suspected drift (t - from))^2, with
  /// h = (-(1 + k C), -(1 + k C) t, k).
  double variance(double time, double slope) const;

  /// The contact point is another one, which has nothing to do with the baseline.
  void replace_contact(const ContactPoint& contact);
};

struct DepthForce {
  double depth = 0;  ///< m, from the contact point, corrected for compliance
  double force = 0;  ///< N, corrected for baseline
  double time = 0;   ///< s, from the start of the press; without a time the number of the sample
};

struct PressCurve {
  Baseline baseline;
  ContactPoint contact;
  CommonErrors common;
  std::vector<DepthForce> loading;       ///< from the contact on, in order of time, without pauses
  std::vector<DepthForce> unloading;     ///< back to the contact, in order of time
  int cycles = 0;                        ///< presses found in the record
  int cycle = 0;                         ///< which of them this is, from 1
  double rate = kUnknown;                ///< m/s, mean speed of loading
  double work_loading = 0;               ///< J
  double work_returned = 0;              ///< J; the rest is lost in the specimen; NaN: saturated
  std::optional<Saturation> saturation;  ///< `loading` ends before it
};

/// Sort out one press: the branches by the turning points of the displacement; baseline, drift and
/// contact point with their joint uncertainty (docs/theory-measured.md); the depth less what the
/// machine itself yields. A press beyond the range of the load cell ends where that is reached.
/// @throws Error(Configuration) naming the record: columns of unequal length, time that goes
///   backwards, no press, no such cycle, a press that begins in contact, a force that never rises
///   above the noise, a machine that by its compliance would yield nearly all the travel.
PressCurve analyse_press(const PressRecord& record, const PressSettings& settings);

/// Turn the signs so that displacement grows into the body and force is positive in compression.
/// Both follow from the record: the force differs most from that of the start, before the tool has
/// moved by a fiftieth of its travel, where the tool is deepest.
/// @return the signs that displacement and force were multiplied by.
struct Signs {
  double displacement = 1, force = 1;
};
Signs orient(PressRecord& record);

}  // namespace palpate::measured
