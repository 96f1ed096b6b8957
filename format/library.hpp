// SPDX-License-Identifier: Apache-2.0
// A response library: surface + responses + certificate + provenance, all that a user ships.
// Normative pages: format/schema/library.md (library.h5), format/schema/flat.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "format/numbers.hpp"
#include "format/passivity.hpp"
#include "format/provenance.hpp"
#include "format/vec3.hpp"

namespace palpate {

/// Schemas of a library. They differ so that a reader refuses responses that it does not know.
/// Decoupled responses without more.
inline constexpr int kLibrarySchema = 3;
/// Decoupled responses that relax.
inline constexpr int kRelaxingLibrarySchema = 5;
/// Responses that are coupled or lean, elastic or relaxing.
inline constexpr int kGrippingLibrarySchema = 6;
/// The same that are coupled and lean: the lean grows with the contact. Where schema 6 says both,
/// the lean was that of another model. Refused.
inline constexpr int kLeaningLibrarySchema = 7;
/// Coupled responses with soft axes, which lean or not.
inline constexpr int kSoftLibrarySchema = 8;
/// Coupled responses with a potential of depth and lateral deflection together, which this runtime
/// does not render; so are those of schema 5 that say that they are coupled. Refused.
inline constexpr int kFormerCoupledSchema = 4;
/// Decoupled responses; the bounds of the certificate have other names. Read, never written.
inline constexpr int kFirstLibrarySchema = 1;

/// A response f(d), d >= 0, with f(0) = 0: the force is piecewise quadratic and C1, its slope
/// piecewise linear and continuous. Between knots k and k+1, with h = d_{k+1} - d_k:
///   f'(d) = s_k + (s_{k+1} - s_k)(d - d_k)/h,   f_{k+1} = f_k + h (s_k + s_{k+1})/2.
/// Beyond the last knot the curve continues with the last slope. All s_k >= 0 makes it monotone and
/// non-negative, hence passive; max s_k is its largest slope, exactly; the antiderivative is a
/// cubic and the inverse a square root on each piece. Stored in single precision: what is stored
/// is what is certified and rendered.
struct ResponseCurve {
  std::vector<float> knot;   ///< (K >= 2) m, knot[0] = 0, strictly increasing
  std::vector<float> slope;  ///< (K) N/m, >= 0
};

enum class ResponseStatus : std::uint8_t {
  Fitted = 0,        ///< from the curves of this node
  Interpolated = 1,  ///< from its neighbours
  Hole = 2           ///< no response: triangles at this vertex are a border for the runtime
};

/// How the responses of a node depend on each other.
enum class ResponseKind : std::uint8_t {
  Decoupled,  ///< E = G(z) + H(rho): f^r does not know the depth [Mahvash & Hayward 2005, eq. 32]
  Coupled     ///< E = G(z) + w(z_w) H(rho), z_w the depth that the contact holds
};

/// w(z) = base + the curve, 1: how the lateral response of a node grows with depth. base > 0 and
/// slopes >= 0 keep E >= 0, and the force of a growing deflection opposed to it.
struct CouplingCurve {
  float base = 1;       ///< w(0)
  ResponseCurve curve;  ///< knots in m, slopes in 1/m; empty in a decoupled library

  double largest() const;  ///< w at any depth; infinite where it grows without end
};

/// Largest length of the lean of a node at any depth.
inline constexpr double kMostLean = 0.5;

/// Largest length of the soft axis of a node: the stiffness along it is at least a quarter of that
/// across it.
inline constexpr double kMostSoftAxis = 0.70710678;

/// Largest number of relaxation times of a library.
inline constexpr std::size_t kMaxRelaxationTimes = 8;

struct NodeResponse {
  ResponseStatus status = ResponseStatus::Hole;
  ResponseCurve normal;     ///< f^z(delta^z); slope[0] = 0 so that the slope is continuous at touch
  ResponseCurve lateral;    ///< f^r(delta^r)
  double normal_error = 0;  ///< largest |fit - sample|, N
  double lateral_error = 0;  ///< same, N
  CouplingCurve coupling{};  ///< of a coupled library only
  /// (B) g_i in [0, 1), sum below 1: the fraction of the normal response that relaxes with each
  /// time of the library. Empty at a hole.
  std::vector<float> relaxation{};
  /// sigma, 1: the lateral deflection that a straight press makes, over its depth, across the
  /// press direction. The lateral force against it is the force by which a press leans. In a
  /// coupled library it is w sigma, as the lateral response is w h.
  std::array<float, 3> lean{};
  /// b, 1, of a coupled library only: the lateral response is softer along b, where its stiffness
  /// is (1 - |b|^2)^2 of that across b and the press direction. The sign means nothing; zero: the
  /// response is the same in all lateral directions.
  std::array<float, 3> soft_axis{};
  /// N, largest CurveSample::mesh_error of the curves that the normal response stands for: what the
  /// mesh of the campaign leaves, beside the error of the fit. NaN when unknown. Not in flat files.
  double normal_mesh_error = kUnknown;
  double lateral_mesh_error = kUnknown;  ///< N, the same of the lateral response
};

/// Bounds of one triangle, `runtime` theory page, "certificate".
struct TriangleCertificate {
  double stick = 0;      ///< L_stick, N/m: largest Jacobian norm with the contact point fixed
  double slip = 0;       ///< L_slip, N/m: Lipschitz bound along the path while sliding
  double kappa = 0;      ///< 1/m, bound on the turning rate of n
  double cos_theta = 1;  ///< of the worst angle between n and the facet normal
  bool sliding_passive = false;  ///< the paper's slide needs no energy correction here
};

/// What a device profile yields on this library. NaN: unknown.
struct DeviceCertificate {
  std::string device;      ///< profile name
  double damping = 0;      ///< sigma_0(B), N s/m
  double lowest_rate = 0;  ///< Hz, for the enforced bound L, (C7); infinite: no rate
  double linear_limit =
      0;  ///< N/m at 1 kHz, 2 b/(3 T): exact linear limit with one sample of delay
  double no_delay_limit = 0;                ///< N/m at 1 kHz, 2 b/T
  double coulomb_friction = kUnknown;       ///< sigma_0(S), N
  double delay = kUnknown;                  ///< tau, s
  double position_resolution = kUnknown;    ///< q, m
  double force_resolution = kUnknown;       ///< r, N
  double published_rate = kUnknown;         ///< Hz, 2 L/sigma_0(B) [Mahvash & Hayward 2005, eq. 5]
  double largest_position_step = kUnknown;  ///< m, that dry friction certifies for L, (C8)

  DeviceConstants constants() const {
    return {damping, coulomb_friction, delay, position_resolution, force_resolution};
  }
};

struct Certificate {
  double friction = 0;  ///< mu the bounds were computed for
  double depth = 0;     ///< m, D: deepest depth for which the bounds are valid
  double stick = 0;     ///< N/m, over all triangles
  double slip = 0;      ///< N/m, over all triangles
  /// N/m, L_min: the smallest Lipschitz bound of the force that the runtime can enforce in every
  /// step and at every depth, by rate-limiting slides, (R16). Infinite: none is certain; NaN: not
  /// known.
  double min_lipschitz_bound = std::numeric_limits<double>::quiet_NaN();
  /// N/m, L of Theorem 1: the bound that the runtime enforces by default, for which the rates are
  /// certified. NaN: not chosen, see enforced_lipschitz_bound.
  double lipschitz_bound = std::numeric_limits<double>::quiet_NaN();
  std::int32_t worst_triangle = -1;
  std::string limited_by;  ///< one line: what sets the bound in the worst triangle
  /// What the responses are made of: "simulated", "measured", "simulated shape, measured scale".
  std::string basis = "simulated";
  std::int32_t holes = 0;
  std::int32_t interpolated = 0;
  std::vector<TriangleCertificate> triangles;  ///< (M)
  std::vector<DeviceCertificate> devices;
  double relaxation_rate = 0;  ///< 1/s, K of (C9); 0 where the responses do not relax
};

/// N/m: the Lipschitz bound of the force that the runtime enforces by default: that of the
/// certificate; where it has none, max(L_stick, L_slip), at most 4 L_stick and at least L_min.
/// Infinite without a certificate.
double enforced_lipschitz_bound(const Certificate& certificate);

/// N/m: the bound above where it is certain that the runtime can enforce it; infinite where slides
/// have no bound and L_min is not known.
double certified_lipschitz_bound(const Certificate& certificate);

/// The force of a library under a Lipschitz bound (N/m), as the conditions of passivity see it.
inline RenderedForce rendered_force(const Certificate& certificate, double lipschitz_bound) {
  return {lipschitz_bound, certificate.relaxation_rate};
}

struct Library {
  bool relaxes() const { return !relaxation_times.empty(); }
  bool leans() const;          ///< whether a node does
  bool has_soft_axes() const;  ///< whether a node with a response has one

  ResponseKind kind = ResponseKind::Decoupled;
  std::string name;
  std::string tool_shape;
  double tool_radius = 0;       ///< m
  std::vector<Vec3> positions;  ///< (V) m
  std::vector<Vec3> inward;     ///< (V) unit
  std::vector<Triangle>
      triangles;  ///< (M) only those whose vertices may all be touched or bound a hole
  std::vector<NodeResponse> responses;  ///< (V)
  /// (B) tau_i, s, increasing, at most kMaxRelaxationTimes; empty: elastic. The curves are those of
  /// tissue that has had no time to relax.
  std::vector<double> relaxation_times;
  Certificate certificate;  ///< triangles empty until certified
  Provenance provenance;
};

/// The schema of its library.h5.
inline int schema_of(const Library& library) {
  const bool coupled = library.kind == ResponseKind::Coupled, leans = library.leans();
  if (library.has_soft_axes()) return kSoftLibrarySchema;
  if (coupled && leans) return kLeaningLibrarySchema;
  if (coupled || leans) return kGrippingLibrarySchema;
  return library.relaxes() ? kRelaxingLibrarySchema : kLibrarySchema;
}

void write_library(const std::filesystem::path& path, const Library& library);  ///< see write_body

/// Read a library.h5 or a flat library, and check: indices, finite numbers, unit directions, knots
/// increasing from 0, slopes non-negative and finite, equal lengths, schema. @throws Error.
Library read_library(const std::filesystem::path& path);

/// The same from a file in memory; errors say "library in memory". An HDF5 file goes by way of a
/// temporary file in TMPDIR.
Library library_from_bytes(std::string_view bytes);
inline constexpr const char* kInMemory = "library in memory";

}  // namespace palpate
