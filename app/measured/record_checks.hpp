// SPDX-License-Identifier: AGPL-3.0-or-later
// What is doubtful about records: wrong units, drift, forces across the press.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/measured/sidecar.hpp"
#include "fitting/measurement/records/batch.hpp"
#include "fitting/measurement/records/history.hpp"
#include "fitting/measurement/records/press.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// Largest distance of a point from its site, m: the mean edge of the response triangles or four
/// radii of the tool, at most 5 mm. Where no site of a fine surface is that near, the frame or a
/// unit is wrong.
double tolerance_on(const Body& body, double tool_radius);

/// Collects a warning for each doubt. The sidecar and the body must outlive it.
class RecordChecks {
 public:
  RecordChecks(const Sidecar& sidecar, const std::optional<Body>& body);

  /// A wrong unit shows in a tool that is deeper in the body than that is large, and in a depth
  /// that is many times the tool where there is no body to compare with.
  /// @throws Error(Configuration) for a press deeper than the body.
  void check_depth(const std::string& where, const measured::PressCurve& curve);
  /// A wrong unit makes the specimen far stiffer, or softer, than what is soft.
  void check_stiffness(const std::string& where, const measured::PressCurve& curve);
  /// A press beyond the range of the load cell has lost its end.
  void check_range(const std::string& where, const measured::PressCurve& curve);
  /// A record that is kept whole has the readings of such a press among its samples.
  void check_range(const std::string& where, const measured::History& history);
  /// What the samples out of contact leave open about the force at the end of loading.
  void check_drift(const std::string& where, const measured::PressCurve& curve);
  /// Only the part of the force along the press becomes a curve.
  void check_lateral(const std::string& where, const measured::BatchSite& site);
  /// What is known to within half of itself is hardly measured.
  void check_force(const SiteCurves& site);
  /// A curve of coarse records, or of one that begins in contact, has fewer samples than asked for.
  void check_samples(const SiteCurves& site);

  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  /// Nobody can see in a record how well a contact point or a zero that is given is known.
  void check_stated(const Sidecar& sidecar);
  void warn(const std::string& text) { warnings_.push_back(text); }

  double tool_radius_;  ///< m
  PathSection path_;
  std::optional<double> extent_;  ///< m, of the body
  std::vector<std::string> warnings_;
};

}  // namespace palpate::app
