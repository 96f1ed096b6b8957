// SPDX-License-Identifier: AGPL-3.0-or-later
// Drags of one site become the lateral paths of curves.h5: those that repeat each other are
// averaged, with their scatter and the standard uncertainty of the mean.
#pragma once

#include <string>
#include <vector>

#include "fitting/measurement/records/press.hpp"
#include "format/curves.hpp"

namespace palpate::measured {

/// One drag at a constant depth, up to slip.
struct DragCurve {
  double lateral_depth = 0;        ///< m
  double contact_uncertainty = 0;  ///< m, standard: of the depth
  double work_before = 0;          ///< J, of the press that led to it
  Vec3 direction{};                ///< unit, across inward
  std::vector<double> travel;      ///< m, from 0 on, never decreasing
  std::vector<Vec3> force;         ///< N, of the tool on the body, offset removed
  double slip = kUnknown;          ///< m, of travel, where the contact slipped and the drag was cut
};

/// Takes away what comes after the slip: the first of `steps` even steps of travel in which the
/// lateral stiffness has fallen below a fifth of its first value. False when fewer than two steps
/// are left. @throws Error(Configuration) where a step holds no sample.
bool cut_at_slip(DragCurve& drag, int steps, const std::string& where);

struct DragSettings {
  int samples = 12;              ///< of a path, evenly spaced in travel
  double force_calibration = 0;  ///< relative standard uncertainty of the force sensor
};

/// Drags whose depths differ by less than a tenth and whose directions by less than 10 degrees
/// repeat each other. Their mean goes to the travel that all of them reach. With n drags, scatter s
/// between them along the path, force f, noise, depth d and its u_c:
///   force_uncertainty  u^2 = max(s^2, mean(noise^2 + (f u_c/(2 d))^2))/n + (r f)^2.
/// The lateral stiffness of a contact without slip grows as its radius [Mindlin 1949], that of a
/// sphere as the root of the depth [Hertz 1881]: hence f/(2 d).
std::vector<CurvePath> lateral_paths(const std::vector<DragCurve>& drags, const Vec3& inward,
                                     const DragSettings& settings, const std::string& where);

}  // namespace palpate::measured
