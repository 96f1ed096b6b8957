// SPDX-License-Identifier: AGPL-3.0-or-later
#include "watched_contact.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/palpate.h"

namespace palpate::test {
namespace {

constexpr double kForceTolerance =
    1e-9;  // N; at a release 1e-11 m of lateral deflection may be left

struct CurvePoint {
  double force = 0, energy = 0;
};

/// Force and energy of a stored curve at d, from its slopes: f' is linear between knots.
CurvePoint curve_at(const ResponseCurve& curve, double d) {
  CurvePoint at;
  for (std::size_t k = 0; k < curve.knot.size() && d > static_cast<double>(curve.knot[k]); ++k) {
    const bool last = k + 1 == curve.knot.size();
    const double start = static_cast<double>(curve.knot[k]);
    const double s0 = static_cast<double>(curve.slope[k]);
    const double piece = last ? 1 : static_cast<double>(curve.knot[k + 1]) - start;
    const double rate = last ? 0 : (static_cast<double>(curve.slope[k + 1]) - s0) / piece;
    const double x = last ? d - start : std::min(d - start, piece);
    at.energy += x * (at.force + x * (s0 / 2 + x * rate / 6));
    at.force += x * (s0 + x * rate / 2);
  }
  return at;
}

double curve_energy(const ResponseCurve& curve, double d) {
  return curve_at(curve, d).energy;
}

/// w at a depth, from its slopes.
double coupling_weight(const CouplingCurve& coupling, double z) {
  return static_cast<double>(coupling.base) + curve_at(coupling.curve, z).force;
}

double steepest_slope(const ResponseCurve& curve) {
  return static_cast<double>(*std::max_element(curve.slope.begin(), curve.slope.end()));
}

double sharpest_bend(const ResponseCurve& curve) {
  double sharpest = 0;
  for (std::size_t k = 1; k < curve.knot.size(); ++k)
    sharpest =
        std::max(sharpest, static_cast<double>(std::abs(curve.slope[k] - curve.slope[k - 1]) /
                                               (curve.knot[k] - curve.knot[k - 1])));
  return sharpest;
}

/// What no Jacobian of coupled responses can exceed up to a lateral deflection, slip or not. With
/// E = G + w H its entries are g' + w'' H along n, w' h between n and t, w h' and w h/rho across n;
/// a symmetric matrix is no larger than its largest diagonal entry and what stands beside it.
double coupled_steepness(const NodeResponse& node, double depth, double rho) {
  const CurvePoint h = curve_at(node.lateral, rho);
  const ResponseCurve& w = node.coupling.curve;
  const double along = steepest_slope(node.normal) + sharpest_bend(w) * h.energy;
  const double across = coupling_weight(node.coupling, depth) * steepest_slope(node.lateral);
  return std::max(along, across) + steepest_slope(w) * h.force;
}

bool finite(const Vec3& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

}  // namespace

double model_energy(const Library& library, const runtime::ContactObservation& model,
                    const Vec3& x) {
  if (model.point.element < 0) return 0;
  const Triangle& t = library.triangles[static_cast<std::size_t>(model.point.element)];
  const Vec3 r = x - model.contact_point;
  const double depth = dot(r, model.normal);
  const double rho = norm(r - depth * model.normal);
  double energy = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    const NodeResponse& node = library.responses[static_cast<std::size_t>(t[l])];
    const double z = depth - model.offset;
    const double w = library.kind == ResponseKind::Coupled ? coupling_weight(node.coupling, z) : 1;
    energy += model.point.natural[l] *
              (curve_energy(node.normal, z) + w * curve_energy(node.lateral, rho));
  }
  return energy;
}

WatchedContact::WatchedContact(const Library& library, const palpate_library& body,
                               const runtime::ContactSettings& settings)
    : library_(library),
      contact_(body.surface, body.tree, settings),
      bound_(std::min(settings.steepness, palpate_library::limit_of(library))),
      friction_(settings.friction) {}

std::uint32_t WatchedContact::step(const Vec3& x) {
  const runtime::ContactObservation before = seen();
  const std::uint32_t status = contact_.step(x);
  ++steps;
  contacts += status & PALPATE_ACTIVATED ? 1 : 0;
  slides += status & PALPATE_SLIDING ? 1 : 0;
  limited += status & PALPATE_ENERGY_LIMITED ? 1 : 0;
  force_limited += status & PALPATE_FORCE_LIMITED ? 1 : 0;
  drops += status & PALPATE_DROPPED ? 1 : 0;
  always_finite = always_finite && finite(seen().force) && std::isfinite(seen().energy) &&
                  std::isfinite(seen().absorbed) && std::isfinite(seen().tank);
  if (status & PALPATE_BAD_INPUT) {
    // The tip did not move as far as the body knows: what was stored is given up.
    if (finite(x)) last_ = x;
    return status;
  }
  account(x, before);
  compare(x, before);
  last_ = x;
  return status;
}

void WatchedContact::account(const Vec3& x, const runtime::ContactObservation& before) {
  const double energy_before = model_energy(library_, before, x);
  const double energy_after = model_energy(library_, seen(), x);
  work_ += energy_before - model_energy(library_, before, last_);
  lowest = std::min(lowest, work_);
  largest_gain = std::max(largest_gain, energy_after + seen().tank - energy_before - before.tank);
  largest_disagreement = std::max(largest_disagreement, std::abs(work_ - seen().absorbed));
}

/// Whether friction holds the model, with the tip at a deflection: w h(rho) <= mu g(z).
bool WatchedContact::sticks(const runtime::ContactObservation& model, double depth,
                            double rho) const {
  if (model.point.element < 0) return true;
  double lateral = 0, grip = 0;
  const Triangle& t = library_.triangles[static_cast<std::size_t>(model.point.element)];
  for (std::size_t l = 0; l < 3; ++l) {
    const NodeResponse& node = library_.responses[static_cast<std::size_t>(t[l])];
    const double w = coupling_weight(node.coupling, depth);
    lateral += model.point.natural[l] * w * curve_at(node.lateral, rho).force;
    grip += model.point.natural[l] * curve_at(node.normal, depth).force;
  }
  return lateral <= friction_ * grip;
}

void WatchedContact::compare(const Vec3& x, const runtime::ContactObservation& before) {
  if (seen().status & PALPATE_DROPPED) return;  // reported
  const double travel = norm(x - last_);
  const double change = norm(seen().force - before.force);
  const double quotient = change / (bound_ * travel + kForceTolerance);
  if (library_.kind == ResponseKind::Decoupled || before.point.element < 0) {
    steepest_step = std::max(steepest_step, quotient);
    return;
  }
  const Vec3 r = x - before.contact_point;
  const double depth = dot(r, before.normal) - before.offset;
  const double rho = norm(r - dot(r, before.normal) * before.normal);
  const double deepest = std::max(depth, before.deflection.depth);
  const double widest = std::max(rho, before.deflection.lateral);
  if (sticks(before, before.deflection.depth, before.deflection.lateral) &&
      sticks(before, depth, rho)) {
    ++stuck;
    steepest_step = std::max(steepest_step, quotient);
  }
  double steepness = bound_;
  for (const std::int32_t v : library_.triangles[static_cast<std::size_t>(before.point.element)])
    steepness = std::max(
        steepness,
        coupled_steepness(library_.responses[static_cast<std::size_t>(v)], deepest, widest));
  steepest_beyond = std::max(steepest_beyond, change / (steepness * travel + kForceTolerance));
}

}  // namespace palpate::test
