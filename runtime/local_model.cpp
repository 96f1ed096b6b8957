// SPDX-License-Identifier: Apache-2.0
#include "runtime/local_model.hpp"

#include <algorithm>
#include <cstddef>

#include "format/numbers.hpp"
#include "runtime/relaxation.hpp"

namespace palpate::runtime {

double LocalModel::energy(const Deflection& d) const noexcept {
  return respond(d).energy;
}

void LocalModel::replace_memory(const TissueMemory& memory, const Deflection& d,
                                LocalResponse& at) noexcept {
  const RelaxedResponse before = at.relaxed;
  at.relaxed = relaxed_response(memory.normal, before.instant);
  const double change = at.relaxed.force - before.force;
  at.normal_force += change;
  at.friction_normal_force = at.relaxed.force;
  at.force = at.force + change * n_;
  at.energy += at.relaxed.energy - before.energy;
  const LateralMemory &lateral = memory.lateral, &was = memory_->lateral;
  if (lateral.any || was.any)
    relax_laterally(lateral.relaxed(), lateral.relaxed() - was.relaxed(),
                    lateral.stored() - was.stored(), d, at);
  set_memory(memory);
}

/// The force f that is felt becomes limit f/|f|, and q the deflection at which grad H is M plus
/// that. It is between M and the present grad H, so that it has been reached.
LateralSlip LocalModel::relaxed_slip_within(const Deflection& d, const LocalResponse& at,
                                            double limit, TipPieces& pieces) const noexcept {
  const Vec3 relaxed = memory_->lateral.relaxed();
  const Vec3 felt = at.instant_lateral_force * d.tangent - relaxed;
  const Vec3 instant = relaxed + (std::max(limit, 0.0) / at.lateral_force) * felt;
  const double magnitude = norm(instant);
  LateralSlip slip;
  slip.lateral = lateral_reached(at, magnitude, pieces);
  if (!(slip.lateral < kInfinity)) slip.lateral = d.lateral;  // by rounding, at the end of a curve
  if (slip.lateral > 0) slip.tangent = (1 / magnitude) * instant;
  slip.scale = 1;
  slip.direction = d.lateral * d.tangent - slip.lateral * slip.tangent;
  restore_direction(slip);
  return slip;
}

/// The lateral deflection at which a response without memory has a force (N), m. at: of any
/// deflection at this depth.
double LocalModel::lateral_reached(const LocalResponse& at, double force,
                                   TipPieces& pieces) const noexcept {
  pieces.keep_for(response_.nodes(), response_.natural(), lateral_weights());
  return pieces.reach(0, Pair{at.relaxed.instant.force, force}).deflection[1];
}

void LocalModel::slip(const LateralSlip& by, Deflection& d, LocalResponse& at,
                      ToolPieces& pieces) noexcept {
  set_lateral_offset(lateral_offset_ + by.part(1));
  d.lateral = by.lateral;
  d.tangent = by.tangent;
  respond(d, pieces, at);
}

LocalModel LocalModel::moved_to(const SurfacePoint& point, ToolPieces& pieces) const noexcept {
  LocalModel there(*surface_, point, offset_, grip_);
  if (!coupled()) {
    there.hold(there.response_.natural());
    return there;
  }
  there.grip_.micro_slip = grip_.micro_slip - dot(grip_.micro_slip, there.n_) * there.n_;
  there.hold(grip_.scale * there.response_.lateral_weights(grip_.depth, pieces.elastic));
  return there;
}

void LocalModel::renew_grip(Deflection& d, LocalResponse& at, ToolPieces& pieces) noexcept {
  const double depth = std::max(d.depth, 0.0);
  if (!coupled() || depth == grip_.depth) return;
  const Vec3 before = weights_, sheared = shear(d);
  hold(response_.lateral_weights(depth, pieces.elastic));
  if (!(d.lateral > 0)) {
    grip_.depth = depth;
    take_shear(sheared - shear(d));
    return;
  }
  Deflection renewed = d;
  if (depth > grip_.depth) {
    renewed.lateral = lateral_below(d, at.lateral_force, pieces);
    if (!(renewed.lateral > 0)) renewed.tangent = {};
  }
  LocalResponse response;
  respond(renewed, pieces, response);
  if (response.energy > at.energy) {
    hold(before);
    return;
  }
  grip_.depth = depth;
  add_micro_slip(shortened(d, renewed.lateral) + (sheared - shear(d)));
  d = renewed;
  at = response;
}

GripChange LocalModel::grip_change(const Deflection& d, ToolPieces& pieces) const noexcept {
  const double depth = std::max(d.depth, 0.0);
  GripChange change;
  if (depth == grip_.depth && grip_.scale == 1) return change;
  change.wide = response_.lateral_weights(depth, pieces.elastic);
  for (std::size_t l = 0; l < 3; ++l)
    if (weights_[l] > change.wide[l])
      change.scale = std::min(change.scale, change.wide[l] / weights_[l]);
  const auto sum = [](const Vec3& w) { return w[0] + w[1] + w[2]; };
  change.grows = sum(change.wide) > (1 + kLeastGrowth) * (change.scale * sum(weights_));
  return change;
}

void LocalModel::renew_grip(const GripChange& change, Deflection& d, LocalResponse& at,
                            ToolPieces& pieces, const Relaxation& memories) noexcept {
  if (change.scale < 1) shrink_grip(change.scale, d, at);
  if (change.grows) grow_grip(change.wide, d, at, pieces, memories);
}

/// Every lateral force, and what is stored for it, falls by a factor; so does the lean.
void LocalModel::shrink_grip(double scale, const Deflection& d, LocalResponse& at) noexcept {
  const Vec3 sheared = shear(d);
  weights_ = scale * weights_;
  lean_ = scale * lean_;
  grip_.scale *= scale;
  take_shear(sheared - shear(d));
  const Vec3 lateral = at.force - dot(at.force, n_) * n_;
  at.energy = at.relaxed.energy + scale * (at.energy - at.relaxed.energy);
  at.force = at.normal_force * n_ + leaning(scale * lateral);
  at.lateral_force *= scale;
  at.instant_lateral_force *= scale;
  LateralMemory& memory = memory_->lateral;
  memory.relaxed_xy *= scale;
  memory.relaxed_z *= scale;
  memory.stored_and_carried[0] *= scale;
  memory.held *= scale;
}

/// Every vertex is held by its w, and every lateral force stays: q and the p_i become shorter.
void LocalModel::grow_grip(const Vec3& wide, Deflection& d, LocalResponse& at, ToolPieces& pieces,
                           const Relaxation& memories) noexcept {
  const Vec3 held = weights_, sheared = shear(d);
  const LateralMemory before = memory_->lateral;
  hold(wide);
  memory_->lateral = memories.held_at(place(), before);
  Deflection renewed = d;
  if (d.lateral > 0) {
    renewed.lateral =
        std::min(lateral_reached(at, at.instant_lateral_force, pieces.relaxing), d.lateral);
    if (!(renewed.lateral > 0)) renewed.tangent = {};
  }
  LocalResponse response;
  respond(renewed, pieces, response);
  if (response.energy > at.energy) {
    hold(held);
    memory_->lateral = before;
    return;
  }
  grip_.depth = std::max(d.depth, 0.0);
  grip_.scale = 1;
  add_micro_slip(shortened(d, renewed.lateral) + (sheared - shear(d)));
  d = renewed;
  at = response;
}

/// Adds to e what the shear has lost by a change of the lean, so that q stays.
void LocalModel::take_shear(const Vec3& by) noexcept {
  if (lean_ != Vec3{} || by != Vec3{}) add_micro_slip(by);
}

/// Adds to e, and to s what is too much.
void LocalModel::add_micro_slip(const Vec3& by) noexcept {
  const Vec3 whole = grip_.micro_slip + by;
  const double length = norm(whole), most = kMostMicroSlip * surface_->tool_radius();
  grip_.micro_slip = length > most ? (most / length) * whole : whole;
  if (length > most) set_lateral_offset(lateral_offset_ + (whole - grip_.micro_slip));
}

double LocalModel::slip_limit(const Deflection& d, double friction) const noexcept {
  return response_.lateral_inverse(friction * response_.normal(d.depth).force, lateral_weights());
}

double LocalModel::energy_slope(const Deflection& at, const Vec3& d,
                                const Vec3& anchor_rate) const noexcept {
  const Element& e = surface_->element(point_.element);
  Vec3 turn{}, lean_change{};
  double lean_along_normal = 0;
  double change_of_curves = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    const double rate = dot(e.gradient[l], d);
    const NodeCurves& node = response_.node(l);
    turn = turn + rate * surface_->inward(e, l);
    const double w =
        node.coupled() ? grip_.scale * node.coupling().evaluate_from_start(grip_.depth).force : 1.0;
    const Vec3 lean = w * surface_->lean(e, l);
    lean_change = lean_change + rate * lean;
    lean_along_normal += point_.natural[l] * dot(lean, n_);
    change_of_curves += rate * (node.normal().evaluate(at.depth).energy +
                                w * node.lateral().evaluate(at.lateral).energy);
  }
  turn = (1.0 / norm(surface_->direction_sum(point_))) * (turn - dot(turn, n_) * n_);
  const LocalResponse response = respond(at);
  const double depth_rate = dot(lateral_displacement(at) + lateral_offset_, turn) - dot(n_, d);
  const Vec3 tangent = soft_axes_.stretch(at.tangent);
  const double lean_rate = dot(tangent, lean_change - lean_along_normal * turn);
  const double soft_rate = soft_axes_.any() ? turning_of_soft_axes(at, d, turn) : 0;
  return change_of_curves + dot(response.force, n_) * depth_rate -
         response.lateral_force * (dot(tangent, anchor_rate) + at.geometric * dot(tangent, turn) +
                                   (at.depth - 0.5 * grip_.depth) * lean_rate + soft_rate);
}

/// -t . (S' q), m/m: with v_l = P b_l, v_l' = -(b_l . n') n - (b_l . n) n', so that across n
///   -S' = sum (grad n_l . d) v_l v_l^T - sum n_l (b_l . n)(n' v_l^T + v_l n'^T).
double LocalModel::turning_of_soft_axes(const Deflection& at, const Vec3& d,
                                        const Vec3& turn) const noexcept {
  const Element& e = surface_->element(point_.element);
  const Vec3 q = unstretched(at);
  double rate = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    const Vec3 b = surface_->soft_axis(e, l);
    const double along = dot(b, n_);
    const Vec3 v = b - along * n_;
    const double of_t = dot(v, at.tangent), of_q = dot(v, q);
    rate += dot(e.gradient[l], d) * of_t * of_q -
            point_.natural[l] * along * (dot(turn, at.tangent) * of_q + dot(turn, q) * of_t);
  }
  return rate;
}

}  // namespace palpate::runtime
