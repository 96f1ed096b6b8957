// SPDX-License-Identifier: AGPL-3.0-or-later
// Logs of a robot that presses many sites, each along the normal that it measured there: one table,
// in which a column says the site of each row.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fitting/measurement/records/press.hpp"
#include "format/curves.hpp"
#include "format/error.hpp"
#include "format/vec3.hpp"

namespace palpate::measured {

/// The rows of a batch in SI, in the frame of the body; each column has a value per row.
struct BatchLog {
  std::string name;             ///< for messages
  std::vector<double> site;     ///< whole numbers
  std::vector<double> time;     ///< may be empty
  std::vector<Vec3> contact;    ///< logged point at first contact; empty: found from the force
  std::vector<Vec3> outward;    ///< unit normal out of the body, measured
  std::vector<Vec3> position;   ///< logged point of the tool
  std::vector<Vec3> force;      ///< N, of the tool on the body
  std::vector<Vec3> readings;   ///< N, of the channels of the force sensor; may be empty
  double position_to_skin = 0;  ///< m, from the logged point along the press to the tool's tip
};

struct BatchSite;

struct BatchSettings {
  PressSettings press;                 ///< `contact` counts from BatchLog::contact
  std::vector<std::string> leave_out;  ///< numbers of sites
  /// What else a site has to fulfil, given its name for messages: throws Error(Configuration) where
  /// it does not. May be empty.
  std::function<void(const BatchSite&, const std::string&)> check;
};

/// One press of a batch.
struct BatchSite {
  std::string name;             ///< of the site: "site 12"
  Vec3 contact{};               ///< m, where the skin was touched
  Vec3 outward{};               ///< unit, as measured
  PressCurve press;             ///< travel and force along -outward
  double lateral_fraction = 0;  ///< lateral over normal force at the deepest sample
  double sideways = 0;          ///< m, largest travel across the normal
};

/// A site that cannot be used, and why.
struct RefusedSite {
  std::string name;  ///< "site 12"
  Error reason;      ///< its `where` names the record and the site
};

struct Batch {
  std::vector<BatchSite> sites;  ///< never empty
  std::vector<RefusedSite> refused;
};

/// The presses in order of their sites. The travel counts from the contact point against the
/// normal, the force is its part along the travel; what is lateral of both is reported.
///
/// A site is refused by itself: as analyse_press and settings.check; a value that is not finite, a
/// normal or contact point that changes within a site, a normal that is no unit vector, a tool that
/// moves out of the body along its normal, a force that pulls.
/// @throws Error(Configuration) for what is wrong with the whole batch: columns of unequal length,
///   a row whose site is no whole number, a site of leave_out that is not there, no site at all, or
///   none that can be used; then with the reason of the first.
Batch split_batch(const BatchLog& log, const BatchSettings& settings);

/// What the records do not say about themselves.
struct RecordedPathSettings {
  double force_noise = 0;             ///< N, standard, of one sample
  double force_calibration = 0;       ///< relative standard uncertainty of the load cell
  double compliance_uncertainty = 0;  ///< m/N, standard
};

/// The loading branch of one press as it was recorded, sample by sample, for records too coarse for
/// mean_path. With the slope k between neighbours,
///   force_uncertainty  u^2 = noise^2 + v + (r f)^2 + (k f u_C)^2,
/// v the variance of baseline and contact point together (CommonErrors). Samples that go back are
/// refused. A force below 0 is one of the noise, and stays.
/// @throws Error(Configuration) where the depth does not increase from sample to sample.
CurvePath recorded_path(const PressCurve& press, const Vec3& inward,
                        const RecordedPathSettings& settings, const std::string& where);

}  // namespace palpate::measured
