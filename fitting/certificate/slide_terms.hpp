// SPDX-License-Identifier: AGPL-3.0-or-later
// The terms of SlideJacobian, over a set of states.
#pragma once

#include <array>
#include <optional>

#include "fitting/certificate/range.hpp"
#include "format/numbers.hpp"

namespace palpate::fitting::slide {

/// Range of a quantity interpolated from ranges at the vertices, over a part of the triangle.
inline Range over(const std::array<std::array<double, 3>, 3>& part,
                  const std::array<Range, 3>& value) {
  Range result{kInfinity, -kInfinity};
  for (const std::array<double, 3>& n : part)
    result = hull(result, n[0] * value[0] + n[1] * value[1] + n[2] * value[2]);
  return result;
}

inline bool is_zero(const Range& a) {
  return a.low == 0 && a.high == 0;
}

struct Facet {
  Range cosine, sine;                 ///< of the azimuth relative to the middle of the cell
  double cos_turn = 1, sin_turn = 0;  ///< of the azimuth of the middle of the cell
  Range n_N, n_b;                     ///< n along N and b
  Range r;                            ///< length of n in the plane of N and tau
  Range t_tau, n_tau;                 ///< t . tau, n . tau
  Range s_tau;                        ///< s . tau
  Range kappa_t, kappa_s;             ///< t . dn/ds and s . dn/ds along tau, 1/m
  Range lean_t, lean_s;               ///< t . sigma and s . sigma
  Range lean_turn;                    ///< sigma . dn/ds, 1/m
  Range lean_t_rate, lean_s_rate;     ///< t . d sigma/ds and s . d sigma/ds, 1/m
  Range lean_growth;                  ///< t . d sigma/dz, 1/m
  Range lean_s_growth;                ///< s . d sigma/dz, 1/m
};

/// S and B' = -dS/ds along tau, in the frame (t, s) of the facet: there t is the direction of q,
/// which is that of p where there are no soft axes. With l = |S t|: p = S q = rho e for e = S t/l,
/// and d = n x e. The theory page calls q's direction e and p's t.
struct Softening {
  Range e_t, e_s;             ///< t . e and s . e
  Range l, m;                 ///< t . S e and s . S e
  Range det;                  ///< s . S d; t . S d = 0
  Range b_tt, b_ts, b_ss;     ///< B
  Range db_tt, db_ts, db_ss;  ///< B', 1/m

  /// From (n, e, d) to (n, t, s): S v.
  std::array<Range, 3> stretched(const Range& n, const Range& e, const Range& d) const {
    return {n, l * e, m * e + det * d};
  }
};

struct AtVertex {
  Range g, g_z;        ///< without the factor mu
  Range w_z_h, w_h_r;  ///< derivatives of the lateral force w h by z and by rho
  Range excess;        ///< Phi = w h - mu g
  Range h_over_rho;    ///< w h/rho
};

struct Response {
  std::array<Range, 3> g{}, excess{};  ///< at the vertices, for gradients
  Range g_here, g_z, w_z_h, w_h_r, h_over_rho;
};

struct Terms {
  Facet f;
  Response r;
  Range m;             ///< derivative of rho_s by z
  Range g_tau;         ///< derivative of g along tau
  Range mu_g;          ///< mu g
  Range mu_g_z;        ///< derivative of mu g by z
  Range n_z;           ///< that of the force along n: g', less what a growing lean takes
  Range mu_g_tau;      ///< derivative of mu g along tau
  Range limit_rate;    ///< decrease of rho_s along tau
  Range q, p, s;       ///< those of (6), less what a slide to the limit needs of p
  Range length;        ///< |q|, m: rho, or rho/|S t|
  Range rate;          ///< decrease of rho - rho_s per unit motion of c
  double norm_M0 = 0;  ///< |M_0|
  std::optional<Softening> soft;
};

/// Along N and the axes x, y turned by the middle of the azimuth.
struct Axes {
  Range N, x, y;
  /// Along tau and b.
  Range tau(const Facet& f) const { return x * f.cosine + y * f.sine; }
  Range b(const Facet& f) const { return y * f.cosine - x * f.sine; }
};

}  // namespace palpate::fitting::slide
