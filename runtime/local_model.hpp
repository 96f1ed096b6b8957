// SPDX-License-Identifier: Apache-2.0
// The static conservative force field f_i(x) that is active while the contact point is held.
#pragma once

#include "format/vec3.hpp"
#include "runtime/interpolated_response.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// The deflection of the tip in the response coordinates at a contact point.
struct Deflection {
  double geometric = 0;  ///< n . (x - c), m: depth of the tip below the surface at rest
  double depth = 0;      ///< z = geometric - d0, m
  double lateral = 0;    ///< rho >= 0, m
  Vec3 tangent{};        ///< t, unit; zero when rho = 0
};

/// Force and energy of a local model at one tip position.
struct LocalResponse {
  double normal_force = 0;   ///< dE/dz, N; g(z) of decoupled responses
  double lateral_force = 0;  ///< dE/drho, N; h(rho) of decoupled responses
  double energy = 0;  ///< E = sum n_l (G_l(z) + H_l(rho)), J [Mahvash & Hayward 2005, eq. 32]
  Vec3 force{};       ///< f = g n + h t, of the tool ON the body, N [eq. 28]
  double grip = 0;    ///< g(z), N: friction holds up to mu times it
};

/// With c, n = n(c) and the offset d0 held:
///   delta = x - c - d0 n,  z = n . delta,  lateral = delta - z n,  rho = |lateral|,  t =
///   lateral/rho, f(x) = g(z) n + h(rho) t = grad E(x).                      [Mahvash & Hayward
///   2005, eqs. 26-32]
/// Coupled responses: E = sum n_l (G_l(z) + w_l(z) H_l(rho)), and the same f = grad E. Slip is
/// judged by g(z), which the normal force is never below. Decoupled, its Jacobian is g' n n^T + h'
/// t t^T + (h/rho) s s^T with s = n x t: no steeper than the steepest stored slope. noexcept,
/// allocation-free.
class LocalModel {
 public:
  LocalModel(const Surface& surface, const SurfacePoint& point, double offset) noexcept
      : surface_(&surface),
        point_(point),
        c_(surface.position(point)),
        n_(surface.normal(point)),
        response_(surface.response(point)),
        offset_(offset) {}

  Deflection deflection(const Vec3& x) const noexcept {
    Deflection d;
    const Vec3 r = x - c_;
    d.geometric = dot(n_, r);
    d.depth = d.geometric - offset_;
    const Vec3 lateral = r - d.geometric * n_;
    d.lateral = norm(lateral);
    if (d.lateral > 0) d.tangent = (1.0 / d.lateral) * lateral;
    return d;
  }
  LocalResponse respond(const Deflection& d) const noexcept {
    if (response_.coupled()) {
      const auto v = response_.coupled_at(d.depth, d.lateral);
      return {v.normal, v.lateral, v.energy, v.normal * n_ + v.lateral * d.tangent, v.grip};
    }
    const CurveValue g = response_.normal(d.depth);
    const CurveValue h = response_.lateral(d.lateral);
    return {g.force, h.force, g.energy + h.energy, g.force * n_ + h.force * d.tangent, g.force};
  }
  double energy(const Deflection& d) const noexcept;
  /// rho_s = h^{-1}(mu g(z)): the lateral deflection at which slip begins, m.
  double slip_limit(const Deflection& d, double friction) const noexcept;

  /// The same where the response is known and exceeds the limit: rho_s < rho.
  double slip_limit_below(const Deflection& d, const LocalResponse& at,
                          double friction) const noexcept {
    return response_.lateral_inverse_below(friction * at.grip, d.lateral,
                                           response_.lateral_weights(d.depth));
  }

  /// Rate of change of E when c moves by unit length along d in its element while x stays, J/m:
  ///   n' = P (sum u_l grad n_l . d)/|sum n_l u_l|, P the projector normal to n,
  ///   dE/ds = sum (grad n_l . d)(G_l + H_l) + (g rho - h z)(t . n') - g (n . d) - h (t . d)
  ///           - d0 h (t . n'),
  /// with H_l times w_l(z), and dE/dz, dE/drho for g, h, where responses are coupled.
  double energy_slope(const Deflection& at, const Vec3& d) const noexcept;

  const SurfacePoint& point() const noexcept { return point_; }
  const Vec3& contact_point() const noexcept { return c_; }
  const Vec3& normal() const noexcept { return n_; }
  double offset() const noexcept { return offset_; }
  void set_offset(double offset) noexcept { offset_ = offset; }
  double deepest() const noexcept { return response_.deepest(); }
  NodeCurves::InUse curves_in_use(const Deflection& d) const noexcept {
    return response_.node(0).in_use(d.depth, d.lateral);
  }

 private:
  const Surface* surface_;
  SurfacePoint point_;
  Vec3 c_;
  Vec3 n_;
  InterpolatedResponse response_;
  double offset_;
};

}  // namespace palpate::runtime
