// SPDX-License-Identifier: AGPL-3.0-or-later
// Raw curves -> compact passive responses -> certificate. Never includes fem: a simulated and a
// measured curve are the same record.
#pragma once

#include <limits>
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
  bool interpolate = false;  ///< responses of sites that were not computed, from all around, marked
  /// Right in the mean over the triangles instead of at their vertices (between_nodes.hpp).
  bool between_nodes = false;
  ResponseKind kind = ResponseKind::Decoupled;
};

/// Fit every site; monotone, passive and C1 by construction (see ResponseCurve and
/// docs/theory-fitting.md). A site counts when a normal path reaches half of the requested depth
/// and a lateral path has a sample; the others are holes, or filled on request. Sites without
/// curves are holes too, or interpolated on request (fitting/sampling). f^r is the mean over
/// azimuths and held depths; lateral_error is the distance to every single path, so what the mean
/// loses is part of it. Coupled responses have one f^r and a weight w of the depth instead (see
/// CoupledLateral). Vertices keep their numbers; triangles with a held vertex are left out.
/// Deterministic. @throws Error(Configuration) when the curves belong to another body, no site is
/// usable, or coupled responses are asked of lateral paths at a single depth.
Library fit(const Body& body, const Curves& curves, const FitSettings& settings);

/// What a device profile does not state.
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A haptic device as its documentation describes it.
struct DeviceProfile {
  std::string name;
  double damping = kUnknown;           ///< smallest viscous damping over directions, N s/m
  double coulomb_friction = kUnknown;  ///< N
  double peak_force = kUnknown;        ///< N
  std::string source;
};

struct CertifySettings {
  double friction = 0.3;  ///< mu, >= 0
  std::vector<DeviceProfile> devices;
  /// N/m, what the runtime is to hold the change of force to; unknown: enforced_lipschitz_bound.
  double limit = kUnknown;
};

/// What responses with this history are made of: Certificate::basis.
std::string basis_of(const Provenance& provenance);

/// Fill library.certificate: for each triangle the bounds of docs/theory-fitting.md, valid while
/// z + d0 <= D, the deepest knot of the library. A slip bound is infinite where the slide of the
/// contact point itself is not bounded. Triangles at a hole have zeros. Every device gets a row,
/// for the limit of the certificate; all of it is NaN where the damping is unknown. @throws
/// Error(Geometry) where normals cannot be interpolated
/// (|sum n_l u_l| < 0.5 in a triangle, or u_l . facet normal >= 0 with the outward normal);
/// Error(Configuration) for friction < 0, damping <= 0, or a library without a usable triangle. The
/// library is unchanged then.
void certify(Library& library, const CertifySettings& settings);

/// The stiffest response that Theorem 1 [Mahvash & Hayward 2005] certifies for a device with this
/// smallest damping at this rate: sigma_0(B) rate/2, N/m. All bounds grow with the forces, so a
/// library whose bound is L is certified when its forces are scaled by this over L.
double certified_bound(double damping, double rate);

/// What it took to certify a library for a bound.
struct Softening {
  double cap =
      std::numeric_limits<double>::infinity();  ///< N/m, steepest slope left; infinite: none
  std::size_t curves = 0;                       ///< that were changed
  /// Share of the force at the last knot that is lost, over both curves of all nodes.
  double median = 0, p95 = 0, worst = 0;
};

/// Certify for `bound`. Where max(L_stick, L_slip) exceeds it, it becomes the limit that the
/// runtime holds slides back to; where L_hold exceeds it as well, the slopes of all curves are
/// capped at the highest value (by bisection) that brings L_hold down to it. What is stiff is
/// softened, the rest stays as it was. @throws Error(Configuration) when not even a hundredth of
/// the steepest slope is certified; the library then keeps its responses.
Softening soften(Library& library, const CertifySettings& settings, double bound);

}  // namespace palpate::fitting
