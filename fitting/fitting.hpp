// SPDX-License-Identifier: AGPL-3.0-or-later
// Raw curves -> compact passive responses -> certificate. Never includes fem: a simulated and a
// measured curve are the same record.
#pragma once

#include <string>
#include <vector>

#include "format/body.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

struct FitSettings {
  double relative_tolerance = 0.01;   ///< of the local force
  double absolute_tolerance = 0.005;  ///< N; the larger of the two applies
  int max_knots = 12;                 ///< per curve
  bool fill_holes = false;            ///< responses of failed sites from their neighbours, marked
};

/// Fit every site; monotone, passive and C1 by construction (see ResponseCurve).
/// @throws Error(Configuration) when the curves belong to another body or no site is usable.
Library fit(const Body& body, const Curves& curves, const FitSettings& settings);

/// A haptic device as its documentation describes it; unknown values are absent (NaN).
struct DeviceProfile {
  std::string name;
  double damping = 0;          ///< smallest viscous damping over directions, N s/m
  double coulomb_friction = 0; ///< N
  double peak_force = 0;       ///< N
  std::string source;
};

struct CertifySettings {
  double friction = 0.3;  ///< mu, >= 0
  std::vector<DeviceProfile> devices;
};

/// Fill library.certificate. @throws Error(Geometry) where normals cannot be interpolated
/// (|sum n_l u_l| < 0.5 in a triangle, or u_l . facet normal >= 0 with the outward normal).
void certify(Library& library, const CertifySettings& settings);

}  // namespace palpate::fitting
