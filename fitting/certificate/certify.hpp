// SPDX-License-Identifier: AGPL-3.0-or-later
// The certificate of a response library: Lipschitz bounds of its force, and device rates.
#pragma once

#include <string>
#include <vector>

#include "fitting/certificate/device_profile.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

struct CertifySettings {
  double friction = 0.3;  ///< mu, >= 0
  std::vector<DeviceProfile> devices;
  /// What else helps where slides have no bound: "press directions ...". Empty: nothing is known.
  std::string slide_remedy = {};
  /// N/m, the Lipschitz bound that the runtime enforces. NaN: enforced_lipschitz_bound().
  double enforced_bound = kUnknown;
};

/// Origin of responses with this history, for Certificate::basis: "simulated", "measured", or
/// "simulated shape, measured scale".
std::string basis_of(const Provenance& provenance);

/// Fills library.certificate with the bounds of docs/theory-fitting.md for each triangle. They are
/// valid while z + d0 <= D, the deepest knot of the library.
/// The slip bound is infinite where the slide of the contact point is not bounded. Triangles at a
/// hole have bounds of zero. Every device gets a row for the enforced bound; its rates are NaN
/// where the damping is unknown.
/// @throws Error(Geometry) where normals cannot be interpolated (|sum n_l u_l| < 0.5 in a triangle,
/// or u_l . facet normal >= 0 with the outward normal); Error(Configuration) for friction < 0,
/// damping <= 0, or a library without a usable triangle. The library is then unchanged.
void certify(Library& library, const CertifySettings& settings);

}  // namespace palpate::fitting
