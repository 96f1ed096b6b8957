// SPDX-License-Identifier: AGPL-3.0-or-later
// The symbols are those of docs/theory-fitting.md, section "Sliding".
#include "fitting/certificate/slide_jacobian.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/certificate/norm_bound.hpp"
#include "fitting/certificate/slide_terms.hpp"
#include "format/numbers.hpp"

namespace palpate::fitting {
namespace {

using Natural = SlideCell::Natural;
using Values = std::array<Range, 3>;
using slide::is_zero;
using slide::over;

/// Weighted sum of values at the vertices.
double weighted(const Natural& n, const std::array<double, 3>& value) {
  return n[0] * value[0] + n[1] * value[1] + n[2] * value[2];
}

/// Mean slope of a curve from 0 to a deflection.
Range mean_slope(const runtime::CompiledCurve& curve, const Range& d) {
  const Range slopes = slope_range(curve, {0, d.high});
  if (!(d.low > 0)) return slopes;
  return common(slopes, Range::outward(curve.force(d.low) / d.high, curve.force(d.high) / d.low));
}

/// x >= 0 with slope x + curvature x^2 = rise, on a piece whose force rises by at least `rise`.
double solve_piece(double slope, double curvature, double rise) {
  if (!(rise > 0)) return 0;
  return 2 * rise / (slope + std::sqrt(std::max(0.0, slope * slope + 4 * curvature * rise)));
}

}  // namespace

SlideJacobian::SlideJacobian(const ContactElement& element) : element_(&element) {
  const TriangleFrame& frame = element.frame;
  const Vec3 x = (1 / norm(frame.gradient[0])) * frame.gradient[0];
  const Vec3 y = cross(frame.normal, x);
  for (std::size_t l = 0; l < 3; ++l) {
    direction_[l] = {dot(frame.inward[l], frame.normal), dot(frame.inward[l], x),
                     dot(frame.inward[l], y)};
    gradient_[l] = {dot(frame.gradient[l], x), dot(frame.gradient[l], y)};
    soft_axis_[l] = {dot(element.soft_axis[l], frame.normal), dot(element.soft_axis[l], x),
                     dot(element.soft_axis[l], y)};
    lean_[l] = {dot(element.lean[l], frame.normal), dot(element.lean[l], x),
                dot(element.lean[l], y)};
  }
  leans_ = element.leans();
  has_soft_axes_ = element.has_soft_axes();
  for (const double start : element.lateral.cells({0, element.lateral.last_knot()}, 1)) {
    LateralPiece piece{start};
    for (std::size_t l = 0; l < 3; ++l) {
      const runtime::CompiledCurve& h = element.lateral.curves()[l];
      const auto after = std::upper_bound(
          h.pieces().begin() + 1, h.pieces().end(), start,
          [](double d, const runtime::CompiledCurve::Piece& p) { return d < p.start; });
      const runtime::CompiledCurve::Piece& from = *(after - 1);
      const double beyond = start - from.start;
      piece.force[l] = from.force + beyond * (from.slope + beyond * from.curvature);
      piece.slope[l] = from.slope + 2 * beyond * from.curvature;
      piece.curvature[l] = from.curvature;
    }
    lateral_.push_back(piece);
  }
}

SlideJacobian::Turned SlideJacobian::turned(const std::array<std::array<double, 3>, 3>& vertex,
                                            const Facet& facet) {
  const double c0 = facet.cos_turn, s0 = facet.sin_turn;
  Turned along{};
  for (std::size_t l = 0; l < 3; ++l) {
    along[0][l] = vertex[l][0];
    along[1][l] = c0 * vertex[l][1] + s0 * vertex[l][2];
    along[2][l] = -s0 * vertex[l][1] + c0 * vertex[l][2];
  }
  return along;
}

slide::Axes SlideJacobian::interpolated(const SlideCell& cell, const Turned& vectors) {
  const auto component = [&](const std::array<double, 3>& v) {
    return over(cell.part, {Range{v[0], v[0]}, Range{v[1], v[1]}, Range{v[2], v[2]}});
  };
  return {component(vectors[0]), component(vectors[1]), component(vectors[2])};
}

slide::Axes SlideJacobian::interpolated(const SlideCell& cell, const Turned& vectors,
                                        const Weights& weights) {
  const auto component = [&](const std::array<double, 3>& v) {
    return over(cell.part, {v[0] * weights[0], v[1] * weights[1], v[2] * weights[2]});
  };
  return {component(vectors[0]), component(vectors[1]), component(vectors[2])};
}

slide::Axes SlideJacobian::rate(const Facet& f, const Turned& vectors) const {
  const double c0 = f.cos_turn, s0 = f.sin_turn;
  const auto component = [&](const std::array<double, 3>& u) {
    double by_x = 0, by_y = 0;
    for (std::size_t l = 1; l < 3; ++l) {  // differences, so that equal vectors give exactly 0
      by_x += (u[l] - u[0]) * (c0 * gradient_[l][0] + s0 * gradient_[l][1]);
      by_y += (u[l] - u[0]) * (-s0 * gradient_[l][0] + c0 * gradient_[l][1]);
    }
    return by_x * f.cosine + by_y * f.sine;
  };
  return {component(vectors[0]), component(vectors[1]), component(vectors[2])};
}

slide::Axes SlideJacobian::rate(const Facet& f, const Turned& vectors,
                                const Weights& weights) const {
  const auto component = [&](const std::array<double, 3>& v) {
    return along(f, {v[0] * weights[0], v[1] * weights[1], v[2] * weights[2]});
  };
  return {component(vectors[0]), component(vectors[1]), component(vectors[2])};
}

/// tau is the axis x turned by the azimuth; b = N x tau; t is the unit vector normal to n in the
/// plane of N and tau, s = n x t.
slide::Facet SlideJacobian::facet(const SlideCell& cell) const {
  // Relative to the middle of the range, cosines are near 1 and sines are small.
  const double half = cell.azimuth.radius();
  Facet f;
  f.cos_turn = std::cos(cell.azimuth.middle());
  f.sin_turn = std::sin(cell.azimuth.middle());
  f.cosine = {std::cos(half), 1};
  f.sine = {-std::sin(half), std::sin(half)};

  const Turned directions = turned(direction_, f);
  const Axes U = interpolated(cell, directions);
  const Range length = root(square(U.N) + square(U.x) + square(U.y));
  const Axes n{U.N / length, U.x / length, U.y / length};
  f.n_N = n.N;
  f.n_tau = n.tau(f);
  f.n_b = n.b(f);
  f.r = root(square(f.n_N) + square(f.n_tau));
  f.t_tau = f.n_N / f.r;
  f.s_tau = (-1) * (f.n_b * f.n_tau) / f.r;

  // dU/ds along tau; t and s take its part normal to n.
  const Axes change = rate(f, directions);
  const Axes d{change.N / length, change.x / length, change.y / length};
  f.kappa_t = along_t(f, d);
  f.kappa_s = along_s(f, d);
  if (leans_) add_lean(cell, f);
  return f;
}

Range SlideJacobian::along_t(const Facet& f, const Axes& a) {
  return (f.n_N * a.tau(f) - f.n_tau * a.N) / f.r;
}

Range SlideJacobian::along_s(const Facet& f, const Axes& a) {
  return f.r * a.b(f) - f.n_b * (f.n_N * a.N + f.n_tau * a.tau(f)) / f.r;
}

/// sigma is the part of the sum S = sum n_l w_l sigma_l across n; its derivative across n is that
/// of S less (n . S) dn/ds.
void SlideJacobian::add_lean(const SlideCell& cell, Facet& f) const {
  const Turned leans = turned(lean_, f);
  Axes S, change;
  if (element_->coupling) {
    Weights w, growth;
    for (std::size_t l = 0; l < 3; ++l) {
      const runtime::CompiledCurve& coupling = element_->coupling->curves()[l];
      w[l] = weight_range(coupling, cell.z);
      growth[l] = slope_range(coupling, cell.z);
    }
    S = interpolated(cell, leans, w);
    change = rate(f, leans, w);
    const Axes grows = interpolated(cell, leans, growth);
    f.lean_growth = along_t(f, grows);
    f.lean_s_growth = along_s(f, grows);
  } else {
    S = interpolated(cell, leans);
    change = rate(f, leans);
  }
  const Range along_n = f.n_N * S.N + f.n_tau * S.tau(f) + f.n_b * S.b(f);
  f.lean_t = along_t(f, S);
  f.lean_s = along_s(f, S);
  f.lean_turn = f.lean_t * f.kappa_t + f.lean_s * f.kappa_s;
  f.lean_t_rate = along_t(f, change) - along_n * f.kappa_t;
  f.lean_s_rate = along_s(f, change) - along_n * f.kappa_s;
}

Range SlideJacobian::along(const Facet& facet, const Values& value) const {
  const double c0 = facet.cos_turn, s0 = facet.sin_turn;
  const Range first = value[1] - value[0], second = value[2] - value[0];
  const Range by_x = gradient_[1][0] * first + gradient_[2][0] * second;
  const Range by_y = gradient_[1][1] * first + gradient_[2][1] * second;
  const Range x = c0 * by_x + s0 * by_y, y = c0 * by_y - s0 * by_x;
  return x * facet.cosine + y * facet.sine;
}

/// Smallest (or largest) rho at which the lateral force at a position is `limit`; infinite where it
/// stays below.
double SlideJacobian::slip_at(const std::array<double, 3>& weight, double limit,
                              bool largest) const {
  const auto beyond = [&](double force) { return largest ? force > limit : force >= limit; };
  for (std::size_t k = 0; k < lateral_.size(); ++k) {
    const bool last = k + 1 == lateral_.size();
    if (!last && !beyond(weighted(weight, lateral_[k + 1].force))) continue;
    const double rise = limit - weighted(weight, lateral_[k].force);
    const double slope = weighted(weight, lateral_[k].slope);
    const double curvature = weighted(weight, lateral_[k].curvature);
    if (last && !(slope > 0) && (rise > 0 || largest)) return kInfinity;
    return lateral_[k].start + solve_piece(slope, curvature, rise);
  }
  return kInfinity;
}

/// The slip limit of every state lies between the smallest and the largest at the corners and the
/// ends of the depths, since w_l h_l - mu g_l is linear in the natural coordinates.
Range SlideJacobian::slip_limit(const SlideCell& cell) const {
  const ContactElement& e = *element_;
  std::array<double, 3> w_low{1, 1, 1}, w_high{1, 1, 1}, force_low{}, force_high{};
  for (std::size_t l = 0; l < 3; ++l) {
    const runtime::CompiledCurve& g = e.normal.curves()[l];
    if (e.coupling) {
      w_low[l] = e.coupling->curves()[l].weight(cell.z.low);
      w_high[l] = e.coupling->curves()[l].weight(cell.z.high);
    }
    force_low[l] = e.friction * g.force(cell.z.low);
    force_high[l] = e.friction * g.force(cell.z.high);
  }
  const auto at = [](const Natural& n, const std::array<double, 3>& w) {
    return std::array<double, 3>{n[0] * w[0], n[1] * w[1], n[2] * w[2]};
  };
  Range rho{kInfinity, 0};
  for (const Natural& n : cell.part) {
    rho.low = std::min(rho.low, slip_at(at(n, w_high), weighted(n, force_low), false));
    rho.high = std::max(rho.high, slip_at(at(n, w_low), weighted(n, force_high), true));
  }
  return rho;
}

slide::AtVertex SlideJacobian::at_vertex(std::size_t vertex, const Range& z,
                                         const Range& rho) const {
  const ContactElement& e = *element_;
  const runtime::CompiledCurve& normal = e.normal.curves()[vertex];
  const runtime::CompiledCurve& lateral = e.lateral.curves()[vertex];
  const Range h{lateral.force(rho.low), lateral.force(rho.high)};
  const Range h_r = slope_range(lateral, rho);
  AtVertex v;
  v.g = {normal.force(z.low), normal.force(z.high)};
  v.g_z = slope_range(normal, z);
  v.w_h_r = h_r;
  v.h_over_rho = mean_slope(lateral, rho);
  Range lateral_force = h;
  if (e.coupling) {
    const runtime::CompiledCurve& coupling = e.coupling->curves()[vertex];
    const Range w = weight_range(coupling, z);
    const Range w_z = slope_range(coupling, z);
    v.w_z_h = w_z * h;
    v.w_h_r = w * h_r;
    v.h_over_rho = w * v.h_over_rho;
    lateral_force = w * h;
  }
  v.excess = lateral_force - e.friction * v.g;
  return v;
}

slide::Response SlideJacobian::response(const SlideCell& cell, const Range& rho) const {
  Response r;
  Values g_z, w_z_h, w_h_r, h_over_rho;
  for (std::size_t l = 0; l < 3; ++l) {
    const AtVertex v = at_vertex(l, cell.z, rho);
    r.g[l] = v.g;
    r.excess[l] = v.excess;
    g_z[l] = v.g_z;
    w_z_h[l] = v.w_z_h;
    w_h_r[l] = v.w_h_r;
    h_over_rho[l] = v.h_over_rho;
  }
  r.g_here = over(cell.part, r.g);
  r.g_z = over(cell.part, g_z);
  r.w_z_h = over(cell.part, w_z_h);
  r.w_h_r = over(cell.part, w_h_r);
  r.h_over_rho = over(cell.part, h_over_rho);
  return r;
}

/// The terms that divide by w h' are left out where it may be zero.
slide::Terms SlideJacobian::terms_of_any_grip(const SlideCell& cell, const Range& rho) const {
  const double mu = element_->friction;
  Terms x;
  x.r = response(cell, rho);
  if (!(x.r.w_h_r.low > 0)) return x;
  x.f = facet(cell);
  x.mu_g = mu * x.r.g_here;
  x.mu_g_z = mu * x.r.g_z;
  x.limit_rate = along(x.f, x.r.excess) / x.r.w_h_r;
  x.g_tau = along(x.f, x.r.g);
  x.mu_g_tau = mu * x.g_tau;
  if (has_soft_axes_) x.soft = softening(cell, x.f);
  x.length = x.soft ? rho / x.soft->l : rho;
  x.q = x.f.n_tau - x.length * x.f.kappa_t;
  x.p = x.f.t_tau + cell.reach * x.f.kappa_t;
  x.s = x.f.s_tau + cell.reach * x.f.kappa_s;
  return x;
}

/// The rest of the terms. @pre x.r.w_h_r.low > 0
slide::Terms SlideJacobian::with_grip(Terms x, const SlideCell& cell, Grip grip) const {
  const Range shrinking = grip == Grip::Renewed ? x.r.w_z_h : Range{};
  x.m = (element_->friction * x.r.g_z - shrinking) / x.r.w_h_r;
  x.n_z = x.r.g_z;
  if (leans_) add_lean(cell, grip, x);
  if (x.soft) {
    add_softening(x);
    return x;
  }
  x.rate = x.p - x.m * x.q - x.limit_rate;
  const Range zero{};
  const Entries fixed{{{x.n_z, zero, zero}, {x.mu_g_z, zero, zero}, {zero, zero, x.r.h_over_rho}}};
  x.norm_M0 = leans_ ? leaned_norm(x.f, fixed)
                     : std::max(std::hypot(x.n_z.magnitude(), x.mu_g_z.magnitude()),
                                x.r.h_over_rho.magnitude());
  return x;
}

/// The z of (6a): what a lean shears is sigma (z - z_w/2), and z_w = z where responses are coupled.
Range SlideJacobian::sheared_depth(const SlideCell& cell) const {
  return element_->coupling ? 0.5 * cell.z : cell.z;
}

/// (6a): the rates of the coordinates in the frame of A x'; (6b): A changes with the depth.
void SlideJacobian::add_lean(const SlideCell& cell, Grip grip, Terms& x) const {
  const Range z = sheared_depth(cell);
  x.q = x.q - z * x.f.lean_turn;
  x.p = x.p + z * x.f.lean_t_rate - x.f.lean_t * x.q;
  x.s = x.s + z * x.f.lean_s_rate - x.f.lean_s * x.q;
  if (!element_->coupling) return;
  const Range growth =
      x.soft ? x.soft->l * x.f.lean_growth + x.soft->m * x.f.lean_s_growth : x.f.lean_growth;
  const Range grown = x.n_z - x.mu_g * growth;
  x.n_z = grip == Grip::Renewed ? grown : hull(grown, x.n_z);
}

/// (9b): what the turning of A adds to v.
void SlideJacobian::add_lean(const Terms& x, Range& v_n, Range& v_t, Range& v_s) {
  const Range leaning = x.mu_g * x.f.lean_t;
  v_n = v_n - leaning * x.f.lean_turn - x.mu_g * x.f.lean_t_rate + x.r.g_here * x.f.lean_turn;
  v_t = v_t - leaning * x.f.kappa_t;
  v_s = v_s - leaning * x.f.kappa_s;
}

/// A = I - sigma n^T: its first column is (1, -sigma_t, -sigma_s).
double SlideJacobian::leaned_norm(const Facet& f, const Entries& x) const {
  if (!leans_) return norm_bound(x);
  Entries y = x;
  for (auto& row : y) row[0] = row[0] - f.lean_t * row[1] - f.lean_s * row[2];
  for (std::size_t j = 0; j < 3; ++j) y[0][j] = y[0][j] - f.lean_t * y[1][j] - f.lean_s * y[2][j];
  return norm_bound(y);
}

double SlideJacobian::bound(const SlideCell& cell) const {
  const Range rho = slip_limit(cell);
  if (rho.low == kInfinity) return 0;
  if (rho.high == kInfinity) return kInfinity;
  const Terms any = terms_of_any_grip(cell, rho);
  if (!(any.r.w_h_r.low > 0)) return kInfinity;
  const double renewed = bound_of_response(with_grip(any, cell, Grip::Renewed));
  if (!element_->coupling) return renewed;
  return std::max(renewed, bound_of_response(with_grip(any, cell, Grip::Kept)));
}

double SlideJacobian::bound_of_response(const Terms& x) const {
  if (x.soft) return bound_of_soft_response(x);
  Range v_n = x.g_tau - x.n_z * x.q - x.mu_g * x.f.kappa_t;
  Range v_t = x.mu_g_tau - x.mu_g_z * x.q + x.r.g_here * x.f.kappa_t;
  Range v_s = x.r.g_here * x.f.kappa_s - x.r.h_over_rho * x.s;
  if (leans_) add_lean(x, v_n, v_t, v_s);
  if (is_zero(v_n) && is_zero(v_t) && is_zero(v_s))
    return kRoundingFactor * x.norm_M0;  // the force does not depend on c
  if (!(x.rate.low > 0)) return kInfinity;
  const Range w_t = Range{1, 1} / x.rate, w_n = (-1) * x.m / x.rate;
  const Range zero{};
  double norm = std::max(x.norm_M0, leaned_norm(x.f, {{{x.n_z + v_n * w_n, v_n * w_t, zero},
                                                       {x.mu_g_z + v_t * w_n, v_t * w_t, zero},
                                                       {v_s * w_n, v_s * w_t, x.r.h_over_rho}}}));
  if (x.rate.high <= 1) return kRoundingFactor * norm;
  // The runtime moves c by rho - rho_s, which is more than needed: (10d).
  const Range over{std::max(0.0, x.rate.low - 1), x.rate.high - 1};
  const Range u_t = v_t - over * x.r.w_h_r;
  return kRoundingFactor *
         std::max(norm, leaned_norm(x.f, {{{x.n_z - v_n * x.m, v_n, zero},
                                           {x.mu_g_z - u_t * x.m, u_t, zero},
                                           {(-1) * v_s * x.m, v_s, x.r.h_over_rho}}}));
}

SlideCauses SlideJacobian::causes(const SlideCell& state) const {
  const Range rho = slip_limit(state);
  if (!(rho.high < kInfinity)) return {0, kInfinity, kInfinity, kInfinity};
  const Terms any = terms_of_any_grip(state, rho);
  if (!(any.r.w_h_r.low > 0)) return {0, kInfinity, kInfinity, kInfinity};
  const Terms x = with_grip(any, state, Grip::Renewed);
  if (!(x.rate.low > 0)) return {x.norm_M0, kInfinity, kInfinity, kInfinity};
  const double stretch = element_->stretch(state.z);
  const double motion =
      stretch * std::hypot(1.0, x.m.magnitude()) / x.rate.low;  // |w|, times |A|^2
  const auto length = [&](const Range& n, const Range& t, const Range& s) {
    return motion * std::hypot(n.magnitude(), t.magnitude(), s.magnitude());
  };
  const Range turned = rho * x.f.kappa_t;
  SlideCauses causes{
      x.norm_M0, length(x.g_tau, x.mu_g_tau, {}),
      length(x.r.g_z * x.f.n_tau, x.mu_g_z * x.f.n_tau, x.r.h_over_rho * x.f.s_tau),
      length(x.r.g_z * turned - x.mu_g * x.f.kappa_t, x.mu_g_z * turned + x.r.g_here * x.f.kappa_t,
             (x.r.g_here - x.r.h_over_rho * state.reach) * x.f.kappa_s)};
  if (x.soft) {
    const Vector of_soft = soft_turning(x), of_lean = leans_ ? lean_turning(x) : Vector{};
    causes.softening = length(of_soft[0], of_soft[1], of_soft[2]);
    causes.lean = length(of_lean[0], of_lean[1], of_lean[2]);
    return causes;
  }
  if (!leans_) return causes;
  const Range shift = sheared_depth(state) * x.f.lean_turn;
  Range n = x.n_z * shift, t = x.mu_g_z * shift;
  Range s = x.r.h_over_rho * (x.f.lean_s * x.q - sheared_depth(state) * x.f.lean_s_rate);
  add_lean(x, n, t, s);
  causes.lean = length(n, t, s);
  return causes;
}

}  // namespace palpate::fitting
