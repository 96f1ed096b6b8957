// SPDX-License-Identifier: AGPL-3.0-or-later
// The part of SlideJacobian for responses with soft axes; docs/theory-fitting.md, section
// "Sliding".
#include <algorithm>
#include <cmath>

#include "fitting/certificate/slide_jacobian.hpp"
#include "fitting/certificate/slide_terms.hpp"

namespace palpate::fitting {

namespace {

/// sum n_l b_l b_l^T, or its derivative along tau, in the frame (N, tau, b).
struct Tensor {
  Range NN, Nt, Nb, tt, tb, bb;

  std::array<Range, 3> operator*(const std::array<Range, 3>& v) const {
    return {NN * v[0] + Nt * v[1] + Nb * v[2], Nt * v[0] + tt * v[1] + tb * v[2],
            Nb * v[0] + tb * v[1] + bb * v[2]};
  }
};

/// entry(i, j): that of the axes (N, x, y), which are turned by the middle of the azimuth.
template <class Entry>
Tensor along_tau(const slide::Facet& f, const Entry& entry) {
  const Range Nx = entry(0, 1), Ny = entry(0, 2), xx = entry(1, 1), xy = entry(1, 2),
              yy = entry(2, 2);
  const Range cc = square(f.cosine), ss = square(f.sine), cs = f.cosine * f.sine;
  return {entry(0, 0),
          f.cosine * Nx + f.sine * Ny,
          f.cosine * Ny - f.sine * Nx,
          cc * xx + ss * yy + 2 * (cs * xy),
          (cc - ss) * xy + cs * (yy - xx),
          ss * xx + cc * yy - 2 * (cs * xy)};
}

}  // namespace

/// t, s and n have these components along N, tau and b; t has none along b.
slide::Softening SlideJacobian::softening(const SlideCell& cell, const Facet& f) const {
  const Turned b = turned(soft_axis_, f);
  const double c0 = f.cos_turn, s0 = f.sin_turn;
  const auto product = [&](std::size_t i, std::size_t j, std::size_t l) {
    return b[i][l] * b[j][l];
  };
  const auto sum = [&](std::size_t i, std::size_t j) {
    const auto at = [&](std::size_t l) { return Range{product(i, j, l), product(i, j, l)}; };
    return slide::over(cell.part, {at(0), at(1), at(2)});
  };
  const auto change = [&](std::size_t i, std::size_t j) {
    double by_x = 0, by_y = 0;
    for (std::size_t l = 1; l < 3; ++l) {
      const double difference = product(i, j, l) - product(i, j, 0);
      by_x += difference * (c0 * gradient_[l][0] + s0 * gradient_[l][1]);
      by_y += difference * (c0 * gradient_[l][1] - s0 * gradient_[l][0]);
    }
    return by_x * f.cosine + by_y * f.sine;
  };
  const std::array<Range, 3> t{(-1) * f.n_tau / f.r, f.n_N / f.r, {}};
  const std::array<Range, 3> s{(-1) * f.n_b * f.n_N / f.r, (-1) * f.n_b * f.n_tau / f.r, f.r};
  const std::array<Range, 3> n{f.n_N, f.n_tau, f.n_b};
  const auto dot = [](const std::array<Range, 3>& u, const std::array<Range, 3>& v) {
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  };
  const Tensor whole = along_tau(f, sum), rate = along_tau(f, change);
  const auto of_t = whole * t, of_s = whole * s, rate_of_t = rate * t, rate_of_s = rate * s;
  const Range n_t = dot(n, of_t), n_s = dot(n, of_s);
  Softening soft;
  soft.db_tt = dot(t, rate_of_t) - 2 * (f.kappa_t * n_t);
  soft.db_ts = dot(t, rate_of_s) - f.kappa_t * n_s - f.kappa_s * n_t;
  soft.db_ss = dot(s, rate_of_s) - 2 * (f.kappa_s * n_s);
  // |B| is at most that of the longest b_l, and B is not negative.
  const double most = element_->most_softening();
  soft.b_tt = common(dot(t, of_t), {0, most});
  soft.b_ts = common(dot(t, of_s), {-0.5 * most, 0.5 * most});
  soft.b_ss = common(dot(s, of_s), {0, most});
  const Range one{1, 1};
  const Range tt = one - soft.b_tt, ts = (-1) * soft.b_ts, ss = one - soft.b_ss;
  soft.l = common(root(square(tt) + square(ts)), {1 - most, 1});
  soft.e_t = tt / soft.l;
  soft.e_s = ts / soft.l;
  soft.m = ts * (tt + ss) / soft.l;
  soft.det = (tt * ss - square(ts)) / soft.l;
  return soft;
}

/// (6c): p and s become those of S q, in the frame (n, e, d).
void SlideJacobian::add_softening(Terms& x) const {
  const Softening& soft = *x.soft;
  const Range p = x.p, s = x.s;
  const Range along = soft.e_t * soft.db_tt + soft.e_s * soft.db_ts;
  const Range across = soft.e_t * soft.db_ts - soft.e_s * soft.db_tt;
  x.p = soft.l * p + soft.m * s + x.length * along;
  x.s = soft.det * s + x.length * across;
  x.rate = x.p - x.m * x.q - x.limit_rate;
  const Range zero{};
  x.norm_M0 = leaned_norm(x.f, {{{x.n_z, zero, zero},
                                 {soft.l * x.mu_g_z, zero, zero},
                                 {soft.m * x.mu_g_z, zero, square(soft.det) * x.r.h_over_rho}}});
}

/// (9c): what the turning of S adds to the derivative of the force by a motion of c, in the frame
/// (n, t, s).
SlideJacobian::Vector SlideJacobian::soft_turning(const Terms& x) {
  const Softening& soft = *x.soft;
  const Facet& f = x.f;
  // B n' and B' e, across n
  const Range turned_t = soft.b_tt * f.kappa_t + soft.b_ts * f.kappa_s;
  const Range turned_s = soft.b_ts * f.kappa_t + soft.b_ss * f.kappa_s;
  const Range changed_t = soft.db_tt * soft.e_t + soft.db_ts * soft.e_s;
  const Range changed_s = soft.db_ts * soft.e_t + soft.db_ss * soft.e_s;
  return {x.mu_g * (soft.e_t * turned_t + soft.e_s * turned_s),
          x.r.g_here * turned_t - x.mu_g * changed_t, x.r.g_here * turned_s - x.mu_g * changed_s};
}

/// (9b) with S e for t: what the turning of A adds.
SlideJacobian::Vector SlideJacobian::lean_turning(const Terms& x) {
  const Softening& soft = *x.soft;
  const Facet& f = x.f;
  const Range leaning = x.mu_g * (soft.l * f.lean_t + soft.m * f.lean_s);
  const Range rate = soft.l * f.lean_t_rate + soft.m * f.lean_s_rate;
  return {x.r.g_here * f.lean_turn - leaning * f.lean_turn - x.mu_g * rate,
          (-1) * leaning * f.kappa_t, (-1) * leaning * f.kappa_s};
}

/// The same as bound_of_response, with x' in the frame (n, t, s) and S (M_0 + v w^T) S.
double SlideJacobian::bound_of_soft_response(const Terms& x) const {
  const Softening& soft = *x.soft;
  const Range kappa_e = soft.e_t * x.f.kappa_t + soft.e_s * x.f.kappa_s;
  const Range kappa_d = soft.e_t * x.f.kappa_s - soft.e_s * x.f.kappa_t;
  const Range v_n = x.g_tau - x.n_z * x.q - x.mu_g * kappa_e;
  const Range v_e = x.mu_g_tau - x.mu_g_z * x.q + x.r.g_here * kappa_e;
  const Range v_d = x.r.g_here * kappa_d - x.r.h_over_rho * x.s;
  auto v = soft.stretched(v_n, v_e, v_d);
  const Vector of_soft = soft_turning(x), of_lean = leans_ ? lean_turning(x) : Vector{};
  for (std::size_t i = 0; i < 3; ++i) v[i] = v[i] + of_soft[i] + of_lean[i];
  if (slide::is_zero(v[0]) && slide::is_zero(v[1]) && slide::is_zero(v[2]))
    return kRoundingFactor * x.norm_M0;
  if (!(x.rate.low > 0)) return kInfinity;
  const Range zero{}, fixed_d = square(soft.det) * x.r.h_over_rho;
  // M_0 + v (-m, l, m_s)/rate, and with another v over l for a slide that is too long
  const auto matrix = [&](const std::array<Range, 3>& by, const Range& divisor) {
    const std::array<Range, 3> w{(-1) * x.m / divisor, soft.l / divisor, soft.m / divisor};
    const Range first[3] = {x.n_z, soft.l * x.mu_g_z, soft.m * x.mu_g_z};
    Entries entries;
    for (std::size_t i = 0; i < 3; ++i)
      entries[i] = {first[i] + by[i] * w[0], by[i] * w[1], by[i] * w[2]};
    entries[2][2] = entries[2][2] + fixed_d;
    return leaned_norm(x.f, entries);
  };
  const double norm = std::max(x.norm_M0, matrix(v, x.rate));
  const Range moved = x.rate / soft.l;
  if (moved.high <= 1) return kRoundingFactor * norm;
  // The runtime moves c by |q| - |q_s|, which is more than needed: (10d).
  const Range over{std::max(0.0, moved.low - 1), moved.high - 1};
  const auto back = soft.stretched(zero, over * x.r.w_h_r, zero);
  for (std::size_t i = 0; i < 3; ++i) v[i] = v[i] - soft.l * back[i];
  return kRoundingFactor * std::max(norm, matrix(v, soft.l));
}

}  // namespace palpate::fitting
