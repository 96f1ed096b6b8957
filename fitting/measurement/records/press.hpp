// SPDX-License-Identifier: AGPL-3.0-or-later
// One press of a testing machine: from displacement and force over time to force over depth, with
// what is uncertain about it. Theory and tests: docs/theory-measured.md.
#pragma once

#include <string>
#include <vector>

#include "format/numbers.hpp"

namespace palpate::measured {

/// What a machine recorded of one press, in SI. `time` may be empty: drift and rate are unknown
/// then. Displacement grows into the body, force is positive in compression.
struct PressRecord {
  std::string name;  ///< for messages
  std::vector<double> time;
  std::vector<double> displacement;
  std::vector<double> force;
};

enum class ContactMethod {
  Fit,       ///< least squares of the onset, see press_contact
  Threshold  ///< the last crossing of a force, corrected by nothing: biased, for comparison
};

struct PressSettings {
  double compliance = 0;              ///< m/N, of machine and load cell
  double compliance_uncertainty = 0;  ///< m/N, standard
  int cycle = 1;                      ///< which press of the record; -1 is the last
  double exponent = 1.5;              ///< of the onset: 1.5 sphere, 1 flat punch, 2 cone
  ContactMethod method = ContactMethod::Fit;
  double threshold = 0;  ///< N, Threshold only
};

/// Force before contact: force = offset + drift (t - time of the first sample).
struct Baseline {
  double offset = 0;                    ///< N
  double drift = 0;                     ///< N/s; 0 when there is no time
  double drift_uncertainty = kUnknown;  ///< N/s, standard
  double noise = 0;                     ///< N, standard deviation of one sample
};

struct ContactPoint {
  double displacement = 0;  ///< m, of the machine, corrected for compliance
  double uncertainty = 0;   ///< m, standard: noise and choice of the fitted range
};

struct DepthForce {
  double depth = 0;  ///< m, from the contact point, corrected for compliance
  double force = 0;  ///< N, corrected for baseline
};

struct PressCurve {
  Baseline baseline;
  ContactPoint contact;
  std::vector<DepthForce> loading;    ///< from the contact on, in order of time
  std::vector<DepthForce> unloading;  ///< back to the contact, in order of time
  int cycles = 0;                     ///< presses found in the record
  double rate = kUnknown;             ///< m/s, mean speed of loading
  double work_loading = 0;            ///< J
  double work_returned = 0;           ///< J; the rest is lost in the specimen
};

/// Sort out one press: the branches by the turning points of the displacement, baseline and drift
/// from the samples out of contact (after the release as well, where the machine went back so far),
/// the contact point with its uncertainty, the depth less what the machine itself yields.
/// @throws Error(Configuration) naming the record: columns of unequal length, time that goes
///   backwards, no press, no such cycle, a press that begins in contact, a force that never rises
///   above the noise, a machine that by its compliance would yield nearly all the travel.
PressCurve analyse_press(const PressRecord& record, const PressSettings& settings);

/// Turn the signs so that displacement grows into the body and force is positive in compression.
/// Both follow from the record: the force is largest where the tool is deepest.
void orient(PressRecord& record);

/// The onset of force by least squares over the contact point c:
///   f(x) = a0 + a1 z^p + a2 z^(p+1),   z = max(0, x - c),   a1 >= 0,
/// the second term for what bends the curve later (size of the tool, large strain, thickness).
/// Fitted up to three shares of the largest force; the standard uncertainty joins the one of the
/// fit, widened for correlated residuals, and the spread between the shares.
ContactPoint fit_contact(const std::vector<double>& displacement, const std::vector<double>& force,
                         double exponent, const std::string& where);

}  // namespace palpate::measured
