// SPDX-License-Identifier: AGPL-3.0-or-later
// The symbols are those of docs/theory-fitting.md, section "Sliding".
#include "fitting/certificate/slide_jacobian.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "format/numbers.hpp"

namespace palpate::fitting {
namespace {

using Natural = SlideCell::Natural;
using Values = std::array<Range, 3>;

/// Range of a quantity interpolated from ranges at the vertices, over a part of the triangle.
Range over(const std::array<Natural, 3>& part, const Values& value) {
  Range result{kInfinity, -kInfinity};
  for (const Natural& n : part)
    result = hull(result, n[0] * value[0] + n[1] * value[1] + n[2] * value[2]);
  return result;
}

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

/// Upper bound of the spectral norm of all matrices with entries in these ranges: the norm of the
/// middle plus the Frobenius norm of the radii.
double norm_bound(const std::array<std::array<Range, 3>, 3>& entry) {
  Eigen::Matrix3d middle, radius;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      middle(static_cast<int>(i), static_cast<int>(j)) = entry[i][j].middle();
      radius(static_cast<int>(i), static_cast<int>(j)) = entry[i][j].radius();
    }
  }
  if (!middle.allFinite() || !radius.allFinite()) return kInfinity;
  const Eigen::Matrix3d squared = middle.transpose() * middle;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(squared, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[2])) + radius.norm();
}

bool is_zero(const Range& a) {
  return a.low == 0 && a.high == 0;
}

/// x >= 0 with slope x + curvature x^2 = rise, on a piece whose force rises by at least `rise`.
double solve_piece(double slope, double curvature, double rise) {
  if (!(rise > 0)) return 0;
  return 2 * rise / (slope + std::sqrt(std::max(0.0, slope * slope + 4 * curvature * rise)));
}

}  // namespace

struct SlideJacobian::Facet {
  Range cosine, sine;              ///< of the azimuth relative to `turn`
  double turn = 0;                 ///< azimuth of the middle of the cell
  Range n_N, n_b;                  ///< n along N and b
  Range r;                         ///< length of n in the plane of N and tau
  Range t_tau, n_tau;              ///< t . tau, n . tau
  Range s_tau;                     ///< s . tau
  Range kappa_t, kappa_s;          ///< t . dn/ds and s . dn/ds along tau, 1/m
  Range lean_t, lean_s;            ///< t . sigma and s . sigma
  Range lean_turn;                 ///< sigma . dn/ds, 1/m
  Range lean_t_rate, lean_s_rate;  ///< t . d sigma/ds and s . d sigma/ds, 1/m
  Range lean_growth;               ///< t . d sigma/dz, 1/m
  Range lean_s_growth;             ///< s . d sigma/dz, 1/m
};

/// S in the frame (t, s) of the facet, in which t is the direction of q, and B' = -dS/ds along tau.
/// With l = |S t|: S q = rho e for e = S t/l, and d = n x e.
struct SlideJacobian::Softening {
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

struct SlideJacobian::AtVertex {
  Range g, g_z;        ///< without the factor mu
  Range w_z_h, w_h_r;  ///< derivatives of the lateral force w h by z and by rho
  Range excess;        ///< Phi = w h - mu g
  Range h_over_rho;    ///< w h/rho
};

struct SlideJacobian::Response {
  Values g{}, excess{};  ///< at the vertices, for gradients
  Range g_here, g_z, w_z_h, w_h_r, h_over_rho;
};

struct SlideJacobian::Terms {
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

/// Along N and the axes x, y turned by the middle of the azimuth.
struct SlideJacobian::Axes {
  Range N, x, y;
  /// Along tau and b.
  Range tau(const Facet& f) const { return x * f.cosine + y * f.sine; }
  Range b(const Facet& f) const { return y * f.cosine - x * f.sine; }
};

SlideJacobian::Turned SlideJacobian::turned(const std::array<std::array<double, 3>, 3>& vertex,
                                            double turn) {
  const double c0 = std::cos(turn), s0 = std::sin(turn);
  Turned along{};
  for (std::size_t l = 0; l < 3; ++l) {
    along[0][l] = vertex[l][0];
    along[1][l] = c0 * vertex[l][1] + s0 * vertex[l][2];
    along[2][l] = -s0 * vertex[l][1] + c0 * vertex[l][2];
  }
  return along;
}

SlideJacobian::Axes SlideJacobian::interpolated(const SlideCell& cell, const Turned& vectors) {
  const auto component = [&](const std::array<double, 3>& v) {
    return over(cell.part, {Range{v[0], v[0]}, Range{v[1], v[1]}, Range{v[2], v[2]}});
  };
  return {component(vectors[0]), component(vectors[1]), component(vectors[2])};
}

SlideJacobian::Axes SlideJacobian::interpolated(const SlideCell& cell, const Turned& vectors,
                                                const Weights& weights) {
  const auto component = [&](const std::array<double, 3>& v) {
    return over(cell.part, {v[0] * weights[0], v[1] * weights[1], v[2] * weights[2]});
  };
  return {component(vectors[0]), component(vectors[1]), component(vectors[2])};
}

SlideJacobian::Axes SlideJacobian::rate(const Facet& f, const Turned& vectors) const {
  const double c0 = std::cos(f.turn), s0 = std::sin(f.turn);
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

SlideJacobian::Axes SlideJacobian::rate(const Facet& f, const Turned& vectors,
                                        const Weights& weights) const {
  const auto component = [&](const std::array<double, 3>& v) {
    return along(f, {v[0] * weights[0], v[1] * weights[1], v[2] * weights[2]});
  };
  return {component(vectors[0]), component(vectors[1]), component(vectors[2])};
}

/// tau is the axis x turned by the azimuth; b = N x tau; t is the unit vector normal to n in the
/// plane of N and tau, s = n x t.
SlideJacobian::Facet SlideJacobian::facet(const SlideCell& cell) const {
  // Relative to the middle of the range, cosines are near 1 and sines are small.
  const double half = cell.azimuth.radius();
  Facet f;
  f.turn = cell.azimuth.middle();
  f.cosine = {std::cos(half), 1};
  f.sine = {-std::sin(half), std::sin(half)};

  const Turned directions = turned(direction_, f.turn);
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
  const Turned leans = turned(lean_, f.turn);
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

/// sum n_l b_l b_l^T, or its derivative along tau, in the frame (N, tau, b).
struct SlideJacobian::Tensor {
  Range NN, Nt, Nb, tt, tb, bb;

  std::array<Range, 3> operator*(const std::array<Range, 3>& v) const {
    return {NN * v[0] + Nt * v[1] + Nb * v[2], Nt * v[0] + tt * v[1] + tb * v[2],
            Nb * v[0] + tb * v[1] + bb * v[2]};
  }
};

/// entry(i, j): that of the axes (N, x, y), which are turned by the middle of the azimuth.
template <class Entry>
SlideJacobian::Tensor SlideJacobian::along_tau(const Facet& f, const Entry& entry) {
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

/// t, s and n have these components along N, tau and b; t has none along b.
SlideJacobian::Softening SlideJacobian::softening(const SlideCell& cell, const Facet& f) const {
  const Turned b = turned(soft_axis_, f.turn);
  const double c0 = std::cos(f.turn), s0 = std::sin(f.turn);
  const auto product = [&](std::size_t i, std::size_t j, std::size_t l) {
    return b[i][l] * b[j][l];
  };
  const auto sum = [&](std::size_t i, std::size_t j) {
    const auto at = [&](std::size_t l) { return Range{product(i, j, l), product(i, j, l)}; };
    return over(cell.part, {at(0), at(1), at(2)});
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

Range SlideJacobian::along(const Facet& facet, const Values& value) const {
  const double c0 = std::cos(facet.turn), s0 = std::sin(facet.turn);
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
  Range rho{kInfinity, 0};
  for (const Natural& n : cell.part) {
    std::array<double, 3> w_high{}, w_low{}, force_low{}, force_high{};
    for (std::size_t l = 0; l < 3; ++l) {
      const runtime::CompiledCurve& g = e.normal.curves()[l];
      w_low[l] = w_high[l] = n[l];
      if (e.coupling) {
        w_low[l] *= e.coupling->curves()[l].weight(cell.z.low);
        w_high[l] *= e.coupling->curves()[l].weight(cell.z.high);
      }
      force_low[l] = e.friction * g.force(cell.z.low);
      force_high[l] = e.friction * g.force(cell.z.high);
    }
    rho.low = std::min(rho.low, slip_at(w_high, weighted(n, force_low), false));
    rho.high = std::max(rho.high, slip_at(w_low, weighted(n, force_high), true));
  }
  return rho;
}

SlideJacobian::AtVertex SlideJacobian::at_vertex(std::size_t vertex, const Range& z,
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

SlideJacobian::Response SlideJacobian::response(const SlideCell& cell, const Range& rho) const {
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
SlideJacobian::Terms SlideJacobian::terms(const SlideCell& cell, const Range& rho,
                                          Grip grip) const {
  const double mu = element_->friction;
  Terms x;
  x.f = facet(cell);
  x.r = response(cell, rho);
  if (!(x.r.w_h_r.low > 0)) return x;
  const Range shrinking = grip == Grip::Renewed ? x.r.w_z_h : Range{};
  x.m = (mu * x.r.g_z - shrinking) / x.r.w_h_r;
  x.mu_g = mu * x.r.g_here;
  x.mu_g_z = mu * x.r.g_z;
  x.n_z = x.r.g_z;
  x.limit_rate = along(x.f, x.r.excess) / x.r.w_h_r;
  x.g_tau = along(x.f, x.r.g);
  x.mu_g_tau = mu * x.g_tau;
  if (has_soft_axes_) x.soft = softening(cell, x.f);
  x.length = x.soft ? rho / x.soft->l : rho;
  x.q = x.f.n_tau - x.length * x.f.kappa_t;
  x.p = x.f.t_tau + cell.reach * x.f.kappa_t;
  x.s = x.f.s_tau + cell.reach * x.f.kappa_s;
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
  double bound = bound_of_response(cell, rho, Grip::Renewed);
  if (element_->coupling) bound = std::max(bound, bound_of_response(cell, rho, Grip::Kept));
  return bound;
}

double SlideJacobian::bound_of_response(const SlideCell& cell, const Range& rho, Grip grip) const {
  const Terms x = terms(cell, rho, grip);
  if (!(x.r.w_h_r.low > 0)) return kInfinity;
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
  // The runtime moves c by rho - rho_s, which is more than needed: (9a).
  const Range over{std::max(0.0, x.rate.low - 1), x.rate.high - 1};
  const Range u_t = v_t - over * x.r.w_h_r;
  return kRoundingFactor *
         std::max(norm, leaned_norm(x.f, {{{x.n_z - v_n * x.m, v_n, zero},
                                           {x.mu_g_z - u_t * x.m, u_t, zero},
                                           {(-1) * v_s * x.m, v_s, x.r.h_over_rho}}}));
}

/// What the turning of S and A adds to the derivative of the force by a motion of c, in the frame
/// (n, t, s): (9c), and (9b) with S e for t.
SlideJacobian::Entries::value_type SlideJacobian::turning(const Terms& x) const {
  const Softening& soft = *x.soft;
  const Facet& f = x.f;
  // B n' and B' e, across n
  const Range turned_t = soft.b_tt * f.kappa_t + soft.b_ts * f.kappa_s;
  const Range turned_s = soft.b_ts * f.kappa_t + soft.b_ss * f.kappa_s;
  const Range changed_t = soft.db_tt * soft.e_t + soft.db_ts * soft.e_s;
  const Range changed_s = soft.db_ts * soft.e_t + soft.db_ss * soft.e_s;
  Entries::value_type v{x.mu_g * (soft.e_t * turned_t + soft.e_s * turned_s),
                        x.r.g_here * turned_t - x.mu_g * changed_t,
                        x.r.g_here * turned_s - x.mu_g * changed_s};
  if (!leans_) return v;
  const Range leaning = x.mu_g * (soft.l * f.lean_t + soft.m * f.lean_s);
  const Range rate = soft.l * f.lean_t_rate + soft.m * f.lean_s_rate;
  v[0] = v[0] - leaning * f.lean_turn - x.mu_g * rate + x.r.g_here * f.lean_turn;
  v[1] = v[1] - leaning * f.kappa_t;
  v[2] = v[2] - leaning * f.kappa_s;
  return v;
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
  const auto more = turning(x);
  for (std::size_t i = 0; i < 3; ++i) v[i] = v[i] + more[i];
  if (is_zero(v[0]) && is_zero(v[1]) && is_zero(v[2])) return kRoundingFactor * x.norm_M0;
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

SlideCauses SlideJacobian::causes(const SlideCell& state) const {
  const Range rho = slip_limit(state);
  if (!(rho.high < kInfinity)) return {0, kInfinity, kInfinity, kInfinity};
  const Terms x = terms(state, rho, Grip::Renewed);
  if (!(x.r.w_h_r.low > 0 && x.rate.low > 0)) return {x.norm_M0, kInfinity, kInfinity, kInfinity};
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
    const auto more = turning(x);
    causes.softening = length(more[0], more[1], more[2]);
  }
  if (!leans_ || x.soft) return causes;
  const Range shift = sheared_depth(state) * x.f.lean_turn;
  Range n = x.n_z * shift, t = x.mu_g_z * shift;
  Range s = x.r.h_over_rho * (x.f.lean_s * x.q - sheared_depth(state) * x.f.lean_s_rate);
  add_lean(x, n, t, s);
  causes.lean = length(n, t, s);
  return causes;
}

}  // namespace palpate::fitting
