// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/unit/runtime/watched_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "runtime/palpate.h"

namespace palpate::test {
namespace {

constexpr double kForceTolerance =
    1e-9;  // N; at a release 1e-11 m of lateral deflection may be left

/// m: the runtime takes a lateral deflection this small for none.
constexpr double kNoDeflection = 1e-11;

/// N: a lateral force that relaxes at a deflection of 1e-11 m. A memory that is kept keeps more.
constexpr double kForgotten = 1e-8;

struct CurvePoint {
  double force = 0, energy = 0, slope = 0;
};

/// Force, energy and slope of a stored curve at d, from its slopes: f' is linear between knots.
CurvePoint curve_at(const ResponseCurve& curve, double d) {
  CurvePoint at;
  if (curve.knot.empty() || !(d > static_cast<double>(curve.knot[0]))) return at;
  double start = static_cast<double>(curve.knot[0]), s0 = static_cast<double>(curve.slope[0]);
  double rate = 0;
  for (std::size_t k = 1; k < curve.knot.size(); ++k) {
    const double end = static_cast<double>(curve.knot[k]), s1 = static_cast<double>(curve.slope[k]);
    const double piece = end - start;
    if (d <= end) {
      rate = (s1 - s0) / piece;
      break;
    }
    at.energy += piece * (at.force + piece * (2 * s0 + s1) / 6);
    at.force += piece * (s0 + s1) / 2;
    start = end;
    s0 = s1;
  }
  const double x = d - start;
  at.energy += x * (at.force + x * (s0 / 2 + x * rate / 6));
  at.force += x * (s0 + x * rate / 2);
  at.slope = s0 + x * rate;
  return at;
}

double curve_energy(const ResponseCurve& curve, double d) {
  return curve_at(curve, d).energy;
}

/// w at a depth, from its slopes.
double coupling_weight(const CouplingCurve& coupling, double z) {
  return static_cast<double>(coupling.base) + curve_at(coupling.curve, z).force;
}

/// Weights of the lateral responses of the three vertices at a point: n_l, or n_l w_l of a grip.
std::array<double, 3> lateral_weights(const Library& library, const runtime::SurfacePoint& p,
                                      const runtime::Grip& grip) {
  std::array<double, 3> weights{};
  const Triangle& t = library.triangles[static_cast<std::size_t>(p.element)];
  for (std::size_t l = 0; l < 3; ++l) {
    weights[l] = p.natural[l];
    if (library.kind != ResponseKind::Coupled) continue;
    const NodeResponse& node = library.responses[static_cast<std::size_t>(t[l])];
    weights[l] *= grip.scale * coupling_weight(node.coupling, grip.depth);
  }
  return weights;
}

Vec3 across(const Vec3& normal, const std::array<float, 3>& v) {
  const Vec3 whole = vec3_of(v);
  return whole - dot(whole, normal) * normal;
}

/// S v.
Vec3 stretched(const Library& library, const runtime::ContactObservation& model, const Vec3& v) {
  const Triangle& t = library.triangles[static_cast<std::size_t>(model.point.element)];
  Vec3 sum = v;
  for (std::size_t l = 0; l < 3; ++l) {
    const NodeResponse& node = library.responses[static_cast<std::size_t>(t[l])];
    const Vec3 b = across(model.normal, node.soft_axis);
    sum = sum - (model.point.natural[l] * dot(b, v)) * b;
  }
  return sum;
}

}  // namespace

ModelEnergy model_energy(const Library& library, const runtime::ContactObservation& model,
                         const Vec3& x) {
  if (model.point.element < 0) return {};
  const Triangle& t = library.triangles[static_cast<std::size_t>(model.point.element)];
  const Vec3 r = x - model.contact_point;
  const double depth = dot(r, model.normal);
  ModelEnergy energy;
  const double z = depth - model.offset;
  const std::array<double, 3> weights = lateral_weights(library, model.point, model.grip);
  Vec3 sigma{};
  for (std::size_t l = 0; l < 3; ++l) {
    const auto& lean = library.responses[static_cast<std::size_t>(t[l])].lean;
    sigma = sigma + weights[l] * across(model.normal, lean);
  }
  const Vec3 q = r - depth * model.normal - (z - 0.5 * model.grip.depth) * sigma -
                 model.lateral_offset - model.grip.micro_slip;
  energy.lateral_deflection = stretched(library, model, q);
  const double rho = norm(energy.lateral_deflection);
  energy.depth = z;
  for (std::size_t l = 0; l < 3; ++l) {
    const NodeResponse& node = library.responses[static_cast<std::size_t>(t[l])];
    const CurvePoint g = curve_at(node.normal, z);
    energy.normal += model.point.natural[l] * g.energy;
    energy.normal_force += model.point.natural[l] * g.force;
    energy.lateral += weights[l] * curve_energy(node.lateral, rho);
  }
  return energy;
}

std::vector<double> MemoryTwin::fractions(const runtime::SurfacePoint& p) const {
  std::vector<double> sum(memory_.size());
  const Triangle& t = library_.triangles[static_cast<std::size_t>(p.element)];
  for (std::size_t l = 0; l < 3; ++l)
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] +=
          p.natural[l] *
          static_cast<double>(library_.responses[static_cast<std::size_t>(t[l])].relaxation[i]);
  return sum;
}

namespace {

using Curve = ResponseCurve NodeResponse::*;

/// A response at a point, interpolated.
CurvePoint response_at(const Library& library, const runtime::SurfacePoint& p,
                       const std::array<double, 3>& weights, Curve curve, double d) {
  CurvePoint sum;
  const Triangle& t = library.triangles[static_cast<std::size_t>(p.element)];
  for (std::size_t l = 0; l < 3; ++l) {
    const CurvePoint at = curve_at(library.responses[static_cast<std::size_t>(t[l])].*curve, d);
    sum.force += weights[l] * at.force;
    sum.energy += weights[l] * at.energy;
    sum.slope += weights[l] * at.slope;
  }
  return sum;
}
CurvePoint normal_response(const Library& library, const runtime::SurfacePoint& p, double z) {
  return response_at(library, p, p.natural, &NodeResponse::normal, z);
}

/// Where a response that rises has a force, between `low`, where its force is smaller, and `high`,
/// where it is not: by Newton's method, and by halving where that leaves what is left of the
/// interval. `look` sees every try.
template <class Response, class Look>
double where_it_is(double force, double low, double high, const Response& response,
                   const Look& look) {
  constexpr double kClose = 2 * std::numeric_limits<double>::epsilon();
  double d = high;
  for (int i = 0; i < 200; ++i) {
    const CurvePoint at = response(d);
    look(d, at);
    (at.force < force ? low : high) = d;
    const double newton = d - (at.force - force) / at.slope;
    const double next = newton > low && newton < high ? newton : (low + high) / 2;
    if (at.force == force || std::abs(next - d) <= kClose * d) return d;
    d = next;
  }
  return d;
}

/// G*(F) = max over z of F z - G(z), J; infinite where g stays below F.
double conjugate(const Library& library, const runtime::SurfacePoint& p, double force) {
  if (!(force > 0)) return 0;
  double low = 0, high = 1e-3, best = 0;
  while (normal_response(library, p, high).force < force) {
    low = high;
    high *= 2;
    if (high > 1e6) return std::numeric_limits<double>::infinity();
  }
  where_it_is(
      force, low, high, [&](double z) { return normal_response(library, p, z); },
      [&](double z, const CurvePoint& at) { best = std::max(best, force * z - at.energy); });
  return best;
}

}  // namespace

MemoryTwin::Sums MemoryTwin::sums(const runtime::SurfacePoint& p, double factor) const {
  if (memory_.empty() || p.element < 0) return {};
  const std::vector<double> g = fractions(p);
  Sums sum;
  for (std::size_t i = 0; i < g.size(); ++i) {
    sum.relaxed += g[i] * factor * memory_[i];
    sum.stored += g[i] * conjugate(library_, p, factor * memory_[i]);
  }
  sum.locked = std::max(sum.stored - conjugate(library_, p, sum.relaxed), 0.0);
  return sum;
}

bool MemoryTwin::drags() const {
  return std::any_of(dragged_.begin(), dragged_.end(), [](const Vec3& p) { return p != Vec3{}; });
}

/// h or w h at the place of the memory.
double MemoryTwin::lateral(double rho) const {
  return response_at(library_, place_, held_, &NodeResponse::lateral, rho).force;
}

/// grad H there.
Vec3 MemoryTwin::gradient(const Vec3& q) const {
  const double rho = norm(q);
  return rho > 0 ? (lateral(rho) / rho) * q : Vec3{};
}

/// H there.
double MemoryTwin::lateral_work(double rho) const {
  return response_at(library_, place_, held_, &NodeResponse::lateral, rho).energy;
}

/// With H*(|grad H(p)|) = grad H(p) . p - H(p).
MemoryTwin::LateralSums MemoryTwin::lateral_sums() const {
  LateralSums sum;
  if (!drags()) return sum;
  const std::vector<double> g = fractions(place_);
  for (std::size_t i = 0; i < g.size(); ++i) {
    const Vec3 force = gradient(dragged_[i]);
    sum.relaxed = sum.relaxed + g[i] * force;
    sum.stored += g[i] * (dot(force, dragged_[i]) - lateral_work(norm(dragged_[i])));
  }
  return sum;
}

/// What (R23) adds to H.
double MemoryTwin::lateral_energy(const Vec3& q) const {
  const LateralSums sum = lateral_sums();
  return sum.stored - dot(sum.relaxed, q);
}

/// The deflection, no longer than `longest`, at which grad H is a force.
Vec3 MemoryTwin::deflection_of(const Vec3& force, double longest) const {
  const double size = norm(force);
  if (!(size > 0)) return {};
  if (!(lateral(longest) > size)) return (longest / size) * force;
  const auto response = [&](double rho) {
    return response_at(library_, place_, held_, &NodeResponse::lateral, rho);
  };
  const double rho = where_it_is(size, 0, longest, response, [](double, const CurvePoint&) {});
  return (rho / size) * force;
}

/// V of (R18).
double MemoryTwin::normal_energy(const Sums& memory, const ModelEnergy& elastic) {
  if (!(elastic.normal_force > memory.relaxed)) return memory.locked;
  return elastic.normal - memory.relaxed * elastic.depth + memory.stored;
}

double MemoryTwin::energy(const runtime::ContactObservation& model, const Vec3& x) const {
  const ModelEnergy elastic = model_energy(library_, model, x);
  if (memory_.empty()) return elastic.normal + elastic.lateral;
  return normal_energy(now_, elastic) + elastic.lateral +
         lateral_energy(elastic.lateral_deflection);
}

Vec3 MemoryTwin::lateral_force(const runtime::ContactObservation& model, const Vec3& x) const {
  return gradient(model_energy(library_, model, x).lateral_deflection) - lateral_sums().relaxed;
}

Vec3 MemoryTwin::felt_force(const runtime::ContactObservation& model, const Vec3& x) const {
  return stretched(library_, model, lateral_force(model, x));
}

/// Is there no normal contact?
bool MemoryTwin::has_lost(const runtime::ContactObservation& model, const Vec3& x) const {
  const ModelEnergy elastic = model_energy(library_, model, x);
  return !(elastic.depth > 0) || !(elastic.normal_force > now_.relaxed);
}

double MemoryTwin::pass(const ModelEnergy& elastic, double dt) {
  const Sums before = now_;
  const double target = std::max(elastic.normal_force, before.relaxed);
  for (std::size_t i = 0; i < memory_.size(); ++i)
    memory_[i] = target + (memory_[i] - target) * std::exp(-dt / library_.relaxation_times[i]);
  now_ = sums(place_);
  return normal_energy(before, elastic) - normal_energy(now_, elastic);
}

/// The memories are forces M_i; p_i, which do not become longer, are where the responses have them
/// now.
void MemoryTwin::keep(const std::vector<Vec3>& forces) {
  for (std::size_t i = 0; i < forces.size(); ++i)
    dragged_[i] = deflection_of(forces[i], norm(dragged_[i]));
}

/// The forces M_i times what a contact that is as wide as at this depth leaves of them: none of its
/// vertices is held by more than its w.
std::vector<Vec3> MemoryTwin::shrunk(double depth, double& scale) const {
  const std::array<double, 3> wide =
      lateral_weights(library_, place_, {std::max(depth, 0.0), {}, 1});
  scale = 1;
  for (std::size_t l = 0; l < 3; ++l)
    if (held_[l] > wide[l]) scale = std::min(scale, wide[l] / held_[l]);
  std::vector<Vec3> forces;
  forces.reserve(dragged_.size());
  for (const Vec3& p : dragged_) forces.push_back(scale * gradient(p));
  return forces;
}

/// The contact takes the width of the depth that a local model has at x, (R33): where it shrinks,
/// all forces fall alike; where it grows by more than a 512th, no force changes, unless the energy
/// would rise.
runtime::Grip MemoryTwin::renew(const runtime::ContactObservation& model, const Vec3& x) {
  const ModelEnergy at = model_energy(library_, model, x);
  const runtime::Grip wide{std::max(at.depth, 0.0), {}, 1};
  const std::array<double, 3> weights = lateral_weights(library_, place_, wide);
  const Vec3& q = at.lateral_deflection;
  double scale = 1;
  const std::vector<Vec3> forces = shrunk(at.depth, scale);
  for (double& w : held_) w *= scale;
  const runtime::Grip shrunk_grip{model.grip.depth, {}, model.grip.scale * scale};
  const auto sum = [](const std::array<double, 3>& w) { return w[0] + w[1] + w[2]; };
  if (!(sum(weights) > (1 + 1.0 / 512) * sum(held_))) return shrunk_grip;
  const Vec3 force = gradient(q);
  // With the energy of the press, so that what is less than its rounding decides nothing.
  const double press = normal_energy(now_, at);
  const double before = press + (lateral_work(norm(q)) + lateral_energy(q));
  const std::array<double, 3> held = held_;
  const std::vector<Vec3> dragged = dragged_;
  held_ = weights;
  keep(forces);
  const Vec3 there = deflection_of(force, norm(q));
  if (press + (lateral_work(norm(there)) + lateral_energy(there)) <= before) return wide;
  held_ = held;
  dragged_ = dragged;
  return shrunk_grip;
}

/// To another normal, by the rotation about the axis of both, and away from the tissue.
void MemoryTwin::carry_lateral(const Vec3& normal, double slid) {
  const Vec3 axis = cross(normal_, normal);
  const double cosine = dot(normal_, normal);
  for (Vec3& p : dragged_) {
    const Vec3 turn = cross(axis, p);
    p = cosine > 0 ? std::exp(-slid / library_.tool_radius) *
                         (p + turn + (1 / (1 + cosine)) * cross(axis, turn))
                   : Vec3{};
  }
}

/// The instantaneous force to which the branches relax: that at q, but where the tool has slipped
/// after relaxing, and q is that of afterwards. Then what has relaxed tells.
Vec3 MemoryTwin::target(const runtime::ContactObservation& after, const Vec3& q, double dt) const {
  constexpr double kRounding = 1e-11;  // N
  const std::vector<double> g = fractions(place_);
  Vec3 kept{};
  for (std::size_t i = 0; i < g.size(); ++i)
    kept = kept + (g[i] * std::exp(-dt / library_.relaxation_times[i])) * gradient(dragged_[i]);
  const double part = relaxing_part(dt);
  const Vec3 here = gradient(q);
  if (norm(kept + part * here - after.relaxed_lateral_force) < kRounding) return here;
  return (1 / part) * (after.relaxed_lateral_force - kept);
}

/// sum g_i (1 - exp(-dt/tau_i))
double MemoryTwin::relaxing_part(double dt) const {
  const std::vector<double> g = fractions(place_);
  double part = 0;
  for (std::size_t i = 0; i < g.size(); ++i)
    part += g[i] * -std::expm1(-dt / library_.relaxation_times[i]);
  return part;
}

double MemoryTwin::pass_lateral(const runtime::ContactObservation& after, const Vec3& q,
                                double dt) {
  const Vec3 force = target(after, q, dt);
  const Vec3 at = deflection_of(force, 1);
  const double before = lateral_energy(at);
  for (std::size_t i = 0; i < dragged_.size(); ++i) {
    const Vec3 relaxed = gradient(dragged_[i]);
    const Vec3 next = force + std::exp(-dt / library_.relaxation_times[i]) * (relaxed - force);
    dragged_[i] = deflection_of(next, std::max(norm(dragged_[i]), norm(at)));
  }
  const Vec3 memory = lateral_sums().relaxed;
  const Vec3 felt = gradient(q) - memory, unslipped = force - memory;
  const double scale = norm(felt) / std::max(norm(unslipped), 1e-300);
  misdirected_ = relaxing_part(dt) * norm(felt - std::min(scale, 1.0) * unslipped);
  return before - lateral_energy(at);
}

/// What a slide to p leaves of the memories: (R18) must not rise.
double MemoryTwin::carried(const runtime::SurfacePoint& p, double slid) const {
  if (slid == 0) return 1;
  if (!(now_.relaxed > 0)) return 0;
  double factor = std::exp(-slid / library_.tool_radius);
  for (int i = 0; i < 8; ++i) {
    const double is = sums(p, factor).locked;
    if (is <= now_.locked) return factor;
    factor *= (1 - 1e-12) * now_.locked / is;
  }
  return 0;
}

double MemoryTwin::step(const runtime::ContactObservation& before,
                        const runtime::ContactObservation& after, const Vec3& x, double dt) {
  if (memory_.empty()) {
    place_ = after.point;
    if (place_.element >= 0) held_ = lateral_weights(library_, place_, after.grip);
    return 0;
  }
  if (after.status & PALPATE_DROPPED) {
    forget();
    return 0;
  }
  double dissipated = 0;
  const bool alone = before.point.element < 0 || (after.status & PALPATE_RELEASED) != 0;
  if (alone && now_.relaxed > 0) {
    dissipated = pass({}, dt);
    dt = 0;
  }
  if (alone) std::fill(dragged_.begin(), dragged_.end(), Vec3{});
  if (after.point.element < 0) return dissipated;
  // Only where there was no normal contact may the tissue lose its lateral memory.
  const bool may_lose = !alone && drags() && has_lost(before, x);
  const bool coupled = library_.kind == ResponseKind::Coupled;
  const runtime::Grip grip = coupled && !alone && drags() ? renew(before, x) : after.grip;
  if (place_.element >= 0) {
    const double factor = carried(after.point, norm(after.contact_point - point_));
    for (double& force : memory_) force *= factor;
  }
  if (place_.element < 0 || after.contact_point != point_) now_ = sums(after.point);
  const double slid = place_.element >= 0 ? norm(after.contact_point - point_) : 0;
  place_ = after.point;
  point_ = after.contact_point;
  held_ = lateral_weights(library_, place_, grip);
  const ModelEnergy elastic = model_energy(library_, after, x);
  if (slid > 0) carry_lateral(after.normal, slid);
  normal_ = after.normal;
  if (may_lose && norm(after.relaxed_lateral_force) < kForgotten)
    std::fill(dragged_.begin(), dragged_.end(), Vec3{});
  if (after.grip.depth != grip.depth || after.grip.scale != grip.scale) {
    double scale = 1;
    const std::vector<Vec3> forces = shrunk(elastic.depth, scale);
    held_ = lateral_weights(library_, place_, after.grip);
    keep(forces);
  }
  dissipated += pass_lateral(after, elastic.lateral_deflection, dt);
  return dissipated + pass(elastic, dt);
}

void MemoryTwin::forget() {
  std::fill(memory_.begin(), memory_.end(), 0.0);
  std::fill(dragged_.begin(), dragged_.end(), Vec3{});
  now_ = {};
}

WatchedContact::WatchedContact(const Library& library, const palpate_library& body,
                               const runtime::ContactSettings& settings)
    : library_(library),
      contact_(body.surface, body.tree, settings),
      memory_(library),
      bound_(std::min(settings.lipschitz_bound, enforced_lipschitz_bound(library.certificate))),
      friction_(settings.friction) {
  for (const NodeResponse& node : library.responses)
    largest_fraction_ = std::max(
        largest_fraction_, std::accumulate(node.relaxation.begin(), node.relaxation.end(), 0.0));
}

std::uint32_t WatchedContact::step(const Vec3& x) {
  return step(x, std::pow(10, std::uniform_real_distribution<double>(-5, 0)(random_)));
}

std::uint32_t WatchedContact::step(const Vec3& x, double dt) {
  const runtime::ContactObservation before = seen();
  const std::uint32_t status = contact_.step(x, dt);
  ++steps;
  contacts += status & PALPATE_ACTIVATED ? 1 : 0;
  slides += status & PALPATE_SLIDING ? 1 : 0;
  limited += status & PALPATE_ENERGY_LIMITED ? 1 : 0;
  force_limited += status & PALPATE_FORCE_LIMITED ? 1 : 0;
  always_finite = always_finite && is_finite(seen().force) && std::isfinite(seen().energy) &&
                  std::isfinite(seen().absorbed) && std::isfinite(seen().tank);
  if (status & PALPATE_BAD_INPUT) {
    // The tip did not move as far as the body knows: what was stored is given up.
    if (is_finite(x)) last_ = x;
    memory_.forget();
    return status;
  }
  cuts += status & PALPATE_DROPPED ? 1 : 0;
  account(x, dt, before);
  compare(x, before);
  last_ = x;
  return status;
}

void WatchedContact::account(const Vec3& x, double dt, const runtime::ContactObservation& before) {
  const double energy_before = memory_.energy(before, x);
  work_ += energy_before - memory_.energy(before, last_);
  relaxed_ = memory_.step(before, seen(), x, dt);
  const double energy_after = memory_.energy(seen(), x);
  lowest = std::min(lowest, work_);
  largest_gain = std::max(largest_gain, energy_after + seen().tank - energy_before - before.tank);
  largest_disagreement =
      std::max(largest_disagreement, std::abs(work_ - seen().absorbed) / std::max(work_, 1.0));
}

/// By how much the lateral force is above mu g(z), N.
double WatchedContact::overdraft(const runtime::ContactObservation& model, const Vec3& x) const {
  const double normal = normal_response(library_, model.point, model.deflection.depth).force;
  return norm(memory_.lateral_force(model, x)) - friction_ * (1 - model.relaxed_fraction) * normal;
}

double relaxing_factor(double friction) {
  const double half = friction * friction / 2, mean = 1 + half;
  return mean + std::hypot(half, friction);
}

void WatchedContact::compare(const Vec3& x, const runtime::ContactObservation& before) {
  const double travel = norm(x - last_);
  const double change = norm(seen().force - before.force);
  const double by_relaxing =
      std::sqrt(2 * relaxing_factor(friction_) * bound_ * largest_fraction_ * relaxed_);
  steepest_step =
      std::max(steepest_step, change / (bound_ * travel + by_relaxing + kForceTolerance));
  longest_ = before.point.element < 0 ? travel : std::max(longest_, travel);
  if (seen().point.element < 0) return;
  const double over = overdraft(seen(), x);
  const bool coupled = library_.kind == ResponseKind::Coupled;
  const double one_step = coupled ? 0 : (1 + friction_) * bound_ * longest_;
  largest_overdraft = std::max(largest_overdraft, over / (one_step + kForceTolerance));
  if (norm(seen().lateral_offset) > 0) ++apart;
  const Vec3 felt = seen().force - dot(seen().force, seen().normal) * seen().normal;
  largest_lateral_error =
      std::max(largest_lateral_error,
               std::max(norm(felt - memory_.felt_force(seen(), x)), memory_.misdirected()) /
                   (kForceTolerance + kNoDeflection * bound_));
  if (norm(seen().relaxed_lateral_force) > 0) ++dragged;
}

}  // namespace palpate::test
