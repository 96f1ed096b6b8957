// SPDX-License-Identifier: AGPL-3.0-or-later
// The derivation is in docs/theory-fitting.md, section "Sliding"; symbols and equation numbers are
// the same.
#include "fitting/certificate/slide_bound.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <vector>

#include "fitting/certificate/range.hpp"
#include "format/numbers.hpp"

namespace palpate::fitting {
namespace {

// Intervals of depth are halved until the largest bound is within this factor of the bound at a
// single depth inside its interval, or the halvings are used up. The bound is valid at every stage.
constexpr double kNearEnough = 1.02;
constexpr int kMaxHalvingsOfSlide = 300;

/// Bounds for all contact points of the triangle and depths of a cell, at limiting friction.
struct SlideState {
  Range z;
  Range rho;                  ///< the slip limit rho_s
  double max_g = 0;           ///< largest g
  double depth_slope = 0;     ///< largest |d(g, mu g)/dz|
  double variation = 0;       ///< largest |grad_c (g, mu g)|
  double h_rho = 0;           ///< smallest d(dE/drho)/drho
  double limit_slope = 0;     ///< largest |d rho_s/dz|
  double limit_gradient = 0;  ///< largest |grad_c (mu g - dE/drho)|
  double h_over_rho = 0;      ///< largest lateral force over rho
};

std::array<double, 3> limits(const ContactElement& element, double z) {
  std::array<double, 3> force{};
  for (std::size_t l = 0; l < 3; ++l) {
    force[l] = element.friction * element.normal.curves()[l].force(z);
  }
  return force;
}

using Box = std::array<Range, 3>;  // of a value at the three vertices

/// sup |grad_c v| for vertex values v in a box: a norm is largest at a corner.
double box_gradient(const ContactElement& element, const Box& box) {
  double largest = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<double, 3> v{};
    for (std::size_t l = 0; l < 3; ++l) {
      v[l] = ((corner >> l) & 1u) != 0 ? box[l].high : box[l].low;
    }
    largest = std::max(largest, gradient_norm(element.frame.gradient, v[0], v[1], v[2]));
  }
  return largest;
}

/// sup |grad_c (mu g - h)| at fixed z and rho: the smaller of the bound over the box of vertex
/// values and the sum of both gradients.
double limit_gradient(const ContactElement& element, const SlideState& state, double grad_g) {
  const double apart = element.friction * grad_g + element.lateral.force_gradient(state.rho);
  const std::array<double, 3> low = limits(element, state.z.low);
  const std::array<double, 3> high = limits(element, state.z.high);
  Box box;
  for (std::size_t l = 0; l < 3; ++l) {
    const runtime::CompiledCurve& h = element.lateral.curves()[l];
    box[l] = {low[l] - h.force(state.rho.high), high[l] - h.force(state.rho.low)};
  }
  return std::min(apart, box_gradient(element, box));
}

/// Absent when the contact sticks in the whole cell: no lateral response reaches mu g.
std::optional<SlideState> decoupled_state(const ContactElement& element, const Range& z) {
  const double mu = element.friction;
  SlideState state;
  state.z = z;
  if (mu > 0) {
    state.rho = element.lateral.inverse(limits(element, z.low), limits(element, z.high));
    if (state.rho.low == kInfinity) return std::nullopt;
  }
  const double oblique = std::hypot(1.0, mu);
  const double g_z = element.normal.slope(z).high;
  const double grad_g = element.normal.force_gradient(z);
  state.max_g = element.normal.greatest_force(z.high);
  state.depth_slope = oblique * g_z;
  state.variation = oblique * grad_g;
  if (mu == 0 || state.rho.high == kInfinity) return state;
  state.h_rho = element.lateral.slope(state.rho).low;
  // h/rho <= the largest slope up to rho. Without friction there is no lateral force at all.
  state.h_over_rho = element.lateral.slope({0, state.rho.high}).high;
  state.limit_slope = state.h_rho > 0 ? mu * g_z / state.h_rho : kInfinity;
  state.limit_gradient = limit_gradient(element, state, grad_g);
  return state;
}

/// Derivatives of the lateral force w h over a box of z and rho; each is interpolated from its
/// vertex values.
struct LateralSlopes {
  Range by_depth;  ///< w' h
  Range by_rho;    ///< w h'
};

LateralSlopes lateral_slopes(const ContactElement& element, const Range& z, const Range& rho) {
  double h_low = kInfinity, h_high = 0, w_low = kInfinity, w_high = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    const runtime::CompiledCurve& lateral = element.lateral.curves()[l];
    const runtime::CompiledCurve& w = element.coupling->curves()[l];
    h_low = std::min(h_low, lateral.force(rho.low));
    h_high = std::max(h_high, lateral.force(rho.high));
    w_low = std::min(w_low, w.weight(z.low));
    w_high = std::max(w_high, w.weight(z.high));
  }
  const Range w_z = element.coupling->slope(z);
  const Range h_r = element.lateral.slope(rho);
  return {{w_z.low * h_low, w_z.high * h_high}, {w_low * h_r.low, w_high * h_r.high}};
}

/// The slip limit of every contact point lies between the smallest and the largest deflection at
/// which w_l h_l = mu g_l at a vertex.
Range coupled_limit(const ContactElement& element, const Range& z) {
  std::array<double, 3> low = limits(element, z.low);
  std::array<double, 3> high = limits(element, z.high);
  for (std::size_t l = 0; l < 3; ++l) {
    const runtime::CompiledCurve& w = element.coupling->curves()[l];
    low[l] /= w.weight(z.high);
    high[l] /= w.weight(z.low);
  }
  return element.lateral.inverse(low, high);
}

/// mu g |d sigma/dz|: what a lean that grows with the contact adds to the slope of the force by the
/// depth, where the lateral force is within friction.
double lean_growth(const ContactElement& element, const Range& z) {
  return element.friction * element.normal.greatest_force(z.high) * element.most_lean_growth(z);
}

std::optional<SlideState> coupled_state(const ContactElement& element, const Range& z) {
  const double mu = element.friction;
  SlideState state;
  state.z = z;
  if (mu > 0) {
    state.rho = coupled_limit(element, z);
    if (state.rho.low == kInfinity) return std::nullopt;
    if (state.rho.high == kInfinity) return state;
    if (element.relaxes) state.rho.low = 0;  // slip begins where psi g allows it, psi from 0 to 1
  }
  const LateralSlopes lateral = lateral_slopes(element, z, state.rho);
  const Range g_z = element.normal.slope(z);
  Box g, limit;
  double w_high = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    const runtime::CompiledCurve& normal = element.normal.curves()[l];
    const runtime::CompiledCurve& h = element.lateral.curves()[l];
    const runtime::CompiledCurve& w = element.coupling->curves()[l];
    const Range w_l{w.weight(z.low), w.weight(z.high)};
    w_high = std::max(w_high, w_l.high);
    g[l] = {normal.force(z.low), normal.force(z.high)};
    limit[l] = {w_l.low * h.force(state.rho.low) - mu * g[l].high,
                w_l.high * h.force(state.rho.high) - mu * g[l].low};
    state.max_g = std::max(state.max_g, g[l].high);
  }
  state.depth_slope = std::hypot(g_z.high + lean_growth(element, z), mu * g_z.high);
  state.variation = std::hypot(1.0, mu) * box_gradient(element, g);
  if (!(mu > 0)) return state;
  state.h_over_rho = w_high * element.lateral.slope({0, state.rho.high}).high;
  state.h_rho = lateral.by_rho.low;
  if (!(state.h_rho > 0)) {
    state.limit_slope = kInfinity;  // the slip limit moves without bound
    return state;
  }
  // rho_s' = (mu g' - w' h)/(w h') where the slip limit follows w, mu g'/(w h') where the
  // lateral offset of the grip takes the growth.
  const double low = (mu * g_z.low - lateral.by_depth.high) / state.h_rho;
  state.limit_slope = std::max(std::abs(low), mu * g_z.high / state.h_rho);
  state.limit_gradient = box_gradient(element, limit);
  return state;
}

std::optional<SlideState> slide_state(const ContactElement& element, const Range& z) {
  return element.coupling ? coupled_state(element, z) : decoupled_state(element, z);
}

/// sup |q| of (6).
double rate_of_depth(const ContactElement& element, const SlideState& state) {
  const TriangleFrame& frame = element.frame;
  const double q = state.rho.high / (1 - element.most_softening());
  return frame.sin_theta + (q + element.depth * element.most_lean(state.z)) * frame.kappa;
}

/// |v| of the soft axes, (9c), with what they add to q and s.
double softening_part(const ContactElement& element, const SlideState& state) {
  const double most = element.most_softening();
  if (!(most > 0)) return 0;
  const double mu = element.friction, kappa = element.frame.kappa, least = 1 - most;
  const double turned = most / (2 * least) + (1 + mu) * most;
  const double changed = mu * (1 / least + 1) * element.most_softening_change();
  return state.max_g * (turned * kappa + changed) +
         state.depth_slope * (1 / least - 1) * state.rho.high * kappa;
}

/// What the soft axes take from t . tau of (6): P of (6c) is at least cos theta less this.
double softening_rate(const ContactElement& element, const SlideState& state) {
  const double most = element.most_softening();
  if (!(most > 0)) return 0;
  const TriangleFrame& frame = element.frame;
  const double least = 1 - most;
  const double oblique = frame.sin_theta * frame.sin_theta / (2 * frame.cos_theta);
  return most * frame.cos_theta + oblique * (1 - least * least) / (2 * least) +
         element.most_softening_change() * state.rho.high / least;
}

/// What the lean adds to p of (6) and to the part across it: (6a).
double lean_rate(const ContactElement& element, const SlideState& state) {
  const double lean = element.most_lean(state.z);
  if (!(lean > 0)) return 0;
  return element.depth * element.most_lean_change(state.z) + lean * rate_of_depth(element, state);
}

/// |v| of the lean, (9b), with all terms of q and s that contain it.
double lean_part(const ContactElement& element, const SlideState& state) {
  const double lean = element.most_lean(state.z), kappa = element.frame.kappa;
  if (!(lean > 0)) return 0;
  const double felt = element.friction * state.max_g;
  return state.depth_slope * element.depth * lean * kappa +
         state.h_over_rho * lean_rate(element, state) +
         felt * (lean * (1 + lean) * kappa + element.most_lean_change(state.z)) +
         lean * kappa * state.max_g;
}

/// Largest motion of c for a unit motion of the tool: |w| of the theory page.
double slide_rate(const ContactElement& element, const SlideState& state) {
  const TriangleFrame& frame = element.frame;
  // Terms of order 1 cancel here, so the rounding margin is absolute.
  double margin = frame.cos_theta - element.depth * frame.kappa - (kRoundingFactor - 1);
  margin -= lean_rate(element, state) + softening_rate(element, state);
  if (element.friction > 0) {
    if (!(state.h_rho > 0)) return kInfinity;
    margin -= state.limit_gradient / state.h_rho;
    margin -= state.limit_slope * rate_of_depth(element, state);
  }
  return margin > 0 ? std::hypot(1.0, state.limit_slope) / margin : kInfinity;
}

SlideBound cell_bound(const ContactElement& element, const SlideState& state) {
  const TriangleFrame& frame = element.frame;
  const double mu = element.friction;
  if (state.rho.high == kInfinity) return {kInfinity, {0, kInfinity, 0, 0}};

  const double stretch = element.stretch(state.z);
  SlideCauses causes;
  causes.stiffness = stretch * std::max(state.depth_slope, state.h_over_rho);
  const double rate = stretch * slide_rate(element, state);
  // |v| is at most the sum of its causes, which are reported separately.
  const double q_slant = frame.sin_theta;
  const double q_turn = state.rho.high * frame.kappa;
  const double oblique = frame.sin_theta * frame.sin_theta / (2 * frame.cos_theta);
  const double across = frame.twist * std::max(state.max_g, state.h_over_rho * element.depth);
  const double slant = std::hypot(state.depth_slope * q_slant, state.h_over_rho * oblique);
  const double turned = std::hypot(1.0, mu) * state.max_g * frame.kappa;
  const double curvature = std::hypot(std::hypot(state.depth_slope * q_turn, turned), across);
  const auto scaled = [&](double part) { return part > 0 ? part * rate : 0.0; };
  causes.variation = scaled(state.variation);
  causes.slant = scaled(slant);
  causes.curvature = scaled(curvature);
  causes.lean = scaled(lean_part(element, state));
  causes.softening = scaled(softening_part(element, state));
  const double moving =
      causes.variation + causes.slant + causes.curvature + causes.lean + causes.softening;
  // Without friction and motion the bound is a stored slope, which is exact.
  const double rounding = mu > 0 || moving > 0 ? kRoundingFactor : 1;
  return {rounding * (causes.stiffness + moving), causes};
}

/// Spectral norm of ((a, 0), (b, d)).
double triangular_norm(double a, double b, double d) {
  const double squares = a * a + b * b + d * d, product = a * d;
  const double root = std::sqrt(std::max(0.0, squares * squares - 4 * product * product));
  return std::sqrt(0.5 * (squares + root));
}

/// Bound of the norm of A^T J A for J = ((along, 0), (mixed t, T)) with |T| <= across: blocks of
/// the product are not longer than those of the norms, and the norm of a matrix without negative
/// entries grows with each of them.
double leaned_norm(double lean, double along, double mixed, double across) {
  const double sheared = mixed + lean * across;
  const double a = along + lean * sheared, b = lean * across, c = sheared, d = across;
  if (lean == 0) return triangular_norm(along, mixed, across);
  const double squares = a * a + b * b + c * c + d * d, determinant = a * d - b * c;
  const double root = std::sqrt(std::max(0.0, squares * squares - 4 * determinant * determinant));
  return std::sqrt(0.5 * (squares + root));
}

/// Bound of the norm of A^T M_0 A for M_0 = along n n^T + mixed t n^T + across s s^T, whatever the
/// angle between t and sigma: over each of its ranges the entries are at most those of the largest
/// cosine and sine.
double slipping_norm(double lean, double along, double mixed, double across) {
  if (lean == 0) return std::hypot(along, mixed);
  constexpr int kRanges = 32;
  double largest = 0;
  for (int i = 0; i < kRanges; ++i) {
    const double cosine = lean * std::cos(0.5 * M_PI * i / kRanges),
                 sine = lean * std::sin(0.5 * M_PI * (i + 1) / kRanges);
    const double a = along + cosine * mixed + sine * sine * across, b = sine * across;
    const double first = a * a + mixed * mixed + b * b, last = b * b + across * across;
    const double product = a * b + b * across;
    const double root = std::hypot(first - last, 2 * product);
    largest = std::max(largest, 0.5 * (first + last + root));
  }
  return kRoundingFactor * std::sqrt(largest);
}

/// The same where responses may have soft axes: S t and S s are no longer than 1, and S t has at
/// most (1 - l^2)/(2 l) along S s, where l is the least eigenvalue of S. What it has along S s adds
/// to the norm of the rest; or the blocks bound it.
double slipping_norm(const ContactElement& element, const Range& z, double along, double mixed,
                     double across) {
  const double lean = element.most_lean(z), rest = slipping_norm(lean, along, mixed, across);
  if (!element.has_soft_axes()) return rest;
  const double least = 1 - element.most_softening();
  const double aside = (1 - least * least) / (2 * least);
  const double without_axes = std::max(rest, across);
  return kRoundingFactor * std::min(leaned_norm(lean, along, mixed, across),
                                    without_axes + element.stretch(z) * mixed * aside);
}

/// sup w' h within friction: w h <= mu g there.
double largest_shrinking(const ContactElement& element, const Range& z) {
  double growth = 0;  // w'/w
  for (const runtime::CompiledCurve& w : element.coupling->curves())
    growth = std::max(growth, slope_range(w, z).high / w.weight(z.low));
  return growth * element.friction * element.normal.greatest_force(z.high);
}

/// sup w h', and with it w h/rho, within friction; memories let the force be within friction at any
/// rho.
double lateral_within(const ContactElement& element, const Range& z) {
  const double rho = element.friction > 0 ? coupled_limit(element, z).high : 0;
  const double w = element.coupling->greatest_force(z.high);
  if (!(rho < kInfinity) || element.relaxes) return w * element.lateral.max_slope();
  return w * element.lateral.slope({0, rho}).high;
}

/// Bound of the force at fixed c over a cell of depths, within friction, while the contact shrinks:
/// its lateral part w h changes with z and rho, the normal one with z. The norm of a matrix without
/// negative entries grows with each of them. Within a step w stays, at any rho; memories let the
/// force be within friction at any rho.
double cell_stick(const ContactElement& element, const Range& z) {
  const double any = element.coupling->greatest_force(z.high) * element.lateral.max_slope();
  const double lean = element.most_lean(z), g_z = element.normal.slope(z).high;
  const double fixed = lean > 0 ? leaned_norm(lean, g_z, 0, any) : any;
  return std::max(fixed, leaned_norm(lean, g_z + lean_growth(element, z),
                                     largest_shrinking(element, z), lateral_within(element, z)));
}

/// Bound of a cell of depths of coupled responses at a fixed contact point, with slip over that
/// point included.
double cell_min_bound(const ContactElement& element, const Range& z) {
  const double g_z = element.normal.slope(z).high, lean = element.most_lean(z);
  const double by_depth = g_z + lean_growth(element, z), mixed = element.friction * g_z;
  const double across = lean > 0 || element.has_soft_axes() ? lateral_within(element, z) : 0;
  return std::max(cell_stick(element, z), slipping_norm(element, z, by_depth, mixed, across));
}

/// Below every knot the normal responses are linear. If w is constant there, nothing else depends
/// on depth.
double min_bound_beyond(const ContactElement& element, double depth) {
  const Range beyond{depth, 2 * depth};
  if (element.coupling->slope(beyond).high > 0) return kInfinity;
  const double lateral = element.coupling->greatest_force(depth) * element.lateral.max_slope();
  const double g_z = element.normal.slope(beyond).high, lean = element.most_lean(beyond);
  if (lean > 0 || element.has_soft_axes())
    return kRoundingFactor *
           std::max(slipping_norm(element, beyond, g_z, element.friction * g_z, lateral),
                    leaned_norm(lean, g_z, 0, lateral));
  return kRoundingFactor * std::max(std::hypot(1.0, element.friction) * g_z, lateral);
}

using CellBound = double (*)(const ContactElement&, const Range&);

/// Upper bound over all depths down to `deepest` from bounds over cells of depth.
double over_depths(const ContactElement& element, double deepest, CellBound bound) {
  struct Part {
    double bound;
    Range z;
    bool operator<(const Part& other) const { return bound < other.bound; }
  };
  std::priority_queue<Part> parts;
  const auto add = [&](const Range& z) { parts.push({bound(element, z), z}); };
  const std::vector<double> ends = element.depth_cells(deepest);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) add({ends[k], ends[k + 1]});
  for (int i = 0; i < kMaxHalvingsOfSlide; ++i) {
    const Part worst = parts.top();
    const double half = worst.z.middle();
    if (worst.bound <= kNearEnough * bound(element, {half, half})) break;
    parts.pop();
    add({worst.z.low, half});
    add({half, worst.z.high});
  }
  return kRoundingFactor * parts.top().bound;
}

struct Cell {
  Range z;
  SlideBound bound;
};

/// The bound over a cell of depths; zero without a slide.
Cell make_cell(const ContactElement& element, const Range& z) {
  const auto state = slide_state(element, z);
  return {z, state ? cell_bound(element, *state) : SlideBound{}};
}

bool energy_falls(const ContactElement& element, const SlideState& state) {
  const TriangleFrame& frame = element.frame;
  const double mu = element.friction;
  if (state.rho.high == kInfinity) return false;
  const double ratio = element.normal.energy_ratio(state.z) +
                       (mu > 0 ? mu * element.lateral.energy_ratio(state.rho) : 0.0);
  const double arm = std::max(std::abs(state.rho.high - mu * state.z.low),
                              std::abs(state.rho.low - mu * element.depth));
  const double lean =
      element.depth * element.most_lean(state.z) * frame.kappa + mu * lean_rate(element, state);
  return mu * frame.cos_theta >=
         kRoundingFactor * (frame.sin_theta + ratio + frame.kappa * arm + lean);
}

/// Whether energy_falls holds over a cell, which is halved while it holds at the middle only.
bool energy_falls_in(const ContactElement& element, const Range& z, int halvings_left) {
  const auto state = slide_state(element, z);
  if (!state || energy_falls(element, *state)) return true;
  if (halvings_left == 0) return false;
  const double half = z.middle();
  const auto point = slide_state(element, {half, half});
  if (point && !energy_falls(element, *point)) return false;
  return energy_falls_in(element, {z.low, half}, halvings_left - 1) &&
         energy_falls_in(element, {half, z.high}, halvings_left - 1);
}

/// Bound of |A^T M A| at the largest slopes M and the largest lean at any depth, which the proof of
/// (C10) needs where responses that relax lean; else 0.
double memory_bound(const ContactElement& element) {
  if (!element.relaxes || !element.leans()) return 0;
  double deepest = std::max(element.depth, element.normal.last_knot()), w = 1;
  if (element.coupling) {
    deepest = std::max(deepest, element.coupling->last_knot());
    w = element.coupling->greatest_force(deepest);
  }
  return kRoundingFactor * leaned_norm(element.most_lean({0, deepest}), element.normal.max_slope(),
                                       0, w * element.lateral.max_slope());
}

}  // namespace

double stick_bound(const ContactElement& element) {
  // The Jacobian at a fixed contact point is g' n n^T + h' t t^T + (h/rho) s s^T, its norm is
  // the largest of the three; h/rho <= max h', and interpolated slopes do not exceed those at the
  // vertices.
  if (element.coupling)
    return std::max(over_depths(element, element.depth, cell_stick), memory_bound(element));
  const double lean = element.most_lean({}), g_z = element.normal.max_slope(),
               across = element.lateral.max_slope();
  return lean > 0 ? kRoundingFactor * leaned_norm(lean, g_z, 0, across) : std::max(g_z, across);
}

double min_lipschitz_bound(const ContactElement& element) {
  // Decoupled, |M_0| is sqrt(1 + mu^2) g' across s; along s it is h/rho <= max h'.
  if (!element.coupling) {
    const double lean = element.most_lean({}), g_z = element.normal.max_slope();
    const double across = lean > 0 ? element.lateral.max_slope() : 0;
    const double slipping = slipping_norm(lean, g_z, element.friction * g_z, across);
    return std::max(stick_bound(element),
                    element.friction > 0 ? kRoundingFactor * slipping : slipping);
  }
  const double deepest = std::max(element.normal.last_knot(), element.coupling->last_knot());
  return std::max({over_depths(element, deepest, cell_min_bound),
                   min_bound_beyond(element, deepest), memory_bound(element)});
}

SlideBound slide_bound(const ContactElement& with_memory) {
  ContactElement element = with_memory;
  element.relaxes = false;  // slides over fresh tissue
  const auto less = [](const Cell& a, const Cell& b) { return a.bound.total < b.bound.total; };
  std::priority_queue<Cell, std::vector<Cell>, decltype(less)> cells(less);
  const std::vector<double> ends = element.depth_cells();
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    cells.push(make_cell(element, {ends[k], ends[k + 1]}));
  }
  for (int i = 0; i < kMaxHalvingsOfSlide; ++i) {
    const Cell worst = cells.top();
    const double half = worst.z.middle();
    const double reached = make_cell(element, {half, half}).bound.total;
    if (worst.bound.total <= kNearEnough * reached) break;
    cells.pop();
    cells.push(make_cell(element, {worst.z.low, half}));
    cells.push(make_cell(element, {half, worst.z.high}));
  }
  return cells.top().bound;
}

bool slide_lowers_energy(const ContactElement& element) {
  if (element.coupling || element.relaxes) return false;
  const std::vector<double> ends = element.normal.cells({0, element.depth}, 1);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    if (!energy_falls_in(element, {ends[k], ends[k + 1]}, 6)) return false;
  }
  return true;
}

}  // namespace palpate::fitting
