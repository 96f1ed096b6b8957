// SPDX-License-Identifier: AGPL-3.0-or-later
// The derivation is in docs/theory-fitting.md, section "Sliding"; symbols and numbers are its own.
#include "fitting/slide_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <vector>

namespace palpate::fitting {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Cells of depth are halved until the bound over the worst one is this near to the bound at a
// single depth inside it, or until so many halvings were spent. The bound holds at every stage.
constexpr double kNearEnough = 1.02;
constexpr int kMostHalvings = 300;

/// What holds for all contact points of the triangle, depths in a cell, at limiting friction.
struct SlideState {
  Range z;
  Range rho;       ///< the slip limit rho_s
  double g = 0;    ///< largest normal force
  double g_z = 0;  ///< largest normal slope
  double grad_g = 0;
};

std::array<double, 3> limits(const ContactElement& element, double z) {
  std::array<double, 3> force{};
  for (std::size_t l = 0; l < 3; ++l) {
    force[l] = element.friction * element.normal.curves()[l].force(z);
  }
  return force;
}

/// Absent when the contact sticks in the whole cell: the lateral response never reaches mu g.
std::optional<SlideState> slide_state(const ContactElement& element, const Range& z) {
  SlideState state;
  state.z = z;
  if (element.friction > 0) {
    state.rho = element.lateral.inverse(limits(element, z.low), limits(element, z.high));
    if (state.rho.low == kInfinity) return std::nullopt;
  }
  state.g = element.normal.greatest_force(z.high);
  state.g_z = element.normal.slope(z).high;
  state.grad_g = element.normal.force_gradient(z);
  return state;
}

/// sup |grad_c (mu g - h)| at fixed z and rho: the vector lies in the image of a box of vertex
/// values, whose corners bound it; and it is no larger than the sum of both gradients.
double limit_gradient(const ContactElement& element, const SlideState& state) {
  const double apart = element.friction * state.grad_g + element.lateral.force_gradient(state.rho);
  const std::array<double, 3> low = limits(element, state.z.low);
  const std::array<double, 3> high = limits(element, state.z.high);
  double together = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<double, 3> e{};
    for (std::size_t l = 0; l < 3; ++l) {
      const bool upper = ((corner >> l) & 1u) != 0;
      const double rho = upper ? state.rho.low : state.rho.high;
      e[l] = (upper ? high[l] : low[l]) - element.lateral.curves()[l].force(rho);
    }
    together = std::max(together, gradient_norm(element.frame.gradient, e[0], e[1], e[2]));
  }
  return std::min(apart, together);
}

/// Largest path of c for a unit path of the tool: |w| of the theory page.
double slide_rate(const ContactElement& element, const SlideState& state) {
  const TriangleFrame& frame = element.frame;
  double margin = frame.cos_theta - element.depth * frame.kappa;
  double limit_slope = 0;  // d rho_s / d z
  if (element.friction > 0) {
    const double h_rho = element.lateral.slope(state.rho).low;
    if (!(h_rho > 0)) return kInfinity;
    limit_slope = element.friction * state.g_z / h_rho;
    margin -= limit_gradient(element, state) / h_rho;
    margin -= limit_slope * (frame.sin_theta + state.rho.high * frame.kappa);
  }
  return margin > 0 ? std::hypot(1.0, limit_slope) / margin : kInfinity;
}

SlideBound cell_bound(const ContactElement& element, const SlideState& state) {
  const TriangleFrame& frame = element.frame;
  const double mu = element.friction;
  if (state.rho.high == kInfinity) return {kInfinity, 0, 0, 0, 0, kInfinity};
  // h/rho <= the largest slope up to rho. Without friction there is no lateral force at all.
  const double h_over_rho = mu > 0 ? element.lateral.slope({0, state.rho.high}).high : 0.0;
  const double oblique = std::hypot(1.0, mu);

  SlideBound bound;
  bound.stiffness = std::max(oblique * state.g_z, h_over_rho);
  bound.slide_rate = slide_rate(element, state);
  // |v| <= the sum of its three causes; each keeps its share for the report.
  const double q_slant = frame.sin_theta;
  const double q_turn = state.rho.high * frame.kappa;
  const double lean = frame.sin_theta * frame.sin_theta / (2 * frame.cos_theta);
  const double across = frame.twist * std::max(state.g, h_over_rho * element.depth);
  const double variation = oblique * state.grad_g;
  const double slant = std::hypot(oblique * state.g_z * q_slant, h_over_rho * lean);
  const double curvature =
      std::hypot(oblique * std::hypot(state.g_z * q_turn, state.g * frame.kappa), across);
  const auto scaled = [&](double part) { return part > 0 ? part * bound.slide_rate : 0.0; };
  bound.variation = scaled(variation);
  bound.slant = scaled(slant);
  bound.curvature = scaled(curvature);
  bound.total = bound.stiffness + bound.variation + bound.slant + bound.curvature;
  return bound;
}

struct Cell {
  Range z;
  SlideBound bound;
};

/// The bound over a cell of depths; no slide, no bound to keep.
Cell make_cell(const ContactElement& element, const Range& z) {
  const auto state = slide_state(element, z);
  return {z, state ? cell_bound(element, *state) : SlideBound{}};
}

double middle(const Range& range) {
  return 0.5 * (range.low + range.high);
}

bool energy_falls(const ContactElement& element, const SlideState& state) {
  const TriangleFrame& frame = element.frame;
  const double mu = element.friction;
  if (state.rho.high == kInfinity) return false;
  const double ratio = element.normal.energy_ratio(state.z) +
                       (mu > 0 ? mu * element.lateral.energy_ratio(state.rho) : 0.0);
  const double arm = std::max(std::abs(state.rho.high - mu * state.z.low),
                              std::abs(state.rho.low - mu * element.depth));
  return mu * frame.cos_theta - frame.sin_theta >= ratio + frame.kappa * arm;
}

/// Over a cell, halved while the condition holds at its middle but not over all of it.
bool energy_falls_in(const ContactElement& element, const Range& z, int halvings_left) {
  const auto state = slide_state(element, z);
  if (!state || energy_falls(element, *state)) return true;
  if (halvings_left == 0) return false;
  const double half = middle(z);
  const auto point = slide_state(element, {half, half});
  if (point && !energy_falls(element, *point)) return false;
  return energy_falls_in(element, {z.low, half}, halvings_left - 1) &&
         energy_falls_in(element, {half, z.high}, halvings_left - 1);
}

}  // namespace

SlideBound slide_bound(const ContactElement& element) {
  const auto less = [](const Cell& a, const Cell& b) { return a.bound.total < b.bound.total; };
  std::priority_queue<Cell, std::vector<Cell>, decltype(less)> cells(less);
  const std::vector<double> ends = element.normal.cells({0, element.depth}, 1);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    cells.push(make_cell(element, {ends[k], ends[k + 1]}));
  }
  for (int i = 0; i < kMostHalvings; ++i) {
    const Cell worst = cells.top();
    const double half = middle(worst.z);
    const double reached = make_cell(element, {half, half}).bound.total;
    if (worst.bound.total <= kNearEnough * reached) break;
    cells.pop();
    cells.push(make_cell(element, {worst.z.low, half}));
    cells.push(make_cell(element, {half, worst.z.high}));
  }
  return cells.top().bound;
}

bool slide_lowers_energy(const ContactElement& element) {
  const std::vector<double> ends = element.normal.cells({0, element.depth}, 1);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    if (!energy_falls_in(element, {ends[k], ends[k + 1]}, 6)) return false;
  }
  return true;
}

}  // namespace palpate::fitting
