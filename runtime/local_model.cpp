// SPDX-License-Identifier: Apache-2.0
#include "runtime/local_model.hpp"

#include <algorithm>
#include <cstddef>

#include "format/numbers.hpp"

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
  at.at_depth.friction_normal_force = at.relaxed.force;
  at.at_depth.energy = at.relaxed.energy;
  if (memory.lateral.any || memory_->lateral.any)
    relax_laterally(memory.lateral, memory_->lateral, d, at);
  set_memory(memory);
}

/// Puts a lateral memory in the place of another in a response.
void LocalModel::relax_laterally(const LateralMemory& memory, const LateralMemory& before,
                                 const Deflection& d, LocalResponse& r) const noexcept {
  const Vec3 change = memory.relaxed() - before.relaxed();
  r.lateral_force = norm(r.instant_lateral_force * d.tangent - memory.relaxed());
  r.energy += memory.stored() - before.stored() - d.lateral * dot(change, d.tangent);
  r.force = r.force - change;
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
  pieces.keep_for(response_);
  slip.lateral = pieces.reach(0, Pair{at.relaxed.instant.force, magnitude}).deflection[1];
  if (!(slip.lateral < kInfinity)) slip.lateral = d.lateral;  // by rounding, at the end of a curve
  if (slip.lateral > 0) slip.tangent = (1 / magnitude) * instant;
  slip.scale = 1;
  slip.direction = d.lateral * d.tangent - slip.lateral * slip.tangent;
  slip.distance = norm(slip.direction);
  return slip;
}

void LocalModel::slip(const LateralSlip& by, Deflection& d, LocalResponse& at,
                      ToolPieces& pieces) noexcept {
  set_lateral_offset(lateral_offset_ + by.part(1));
  d.lateral = by.lateral;
  d.tangent = by.tangent;
  if (coupled()) {
    respond_at_depth(d, pieces.elastic, at);
  } else {
    respond(d, pieces, at);
  }
}

double LocalModel::slip_limit(const Deflection& d, double friction) const noexcept {
  return response_.lateral_inverse(friction * response_.normal(d.depth).force,
                                   response_.lateral_weights(d.depth));
}

double LocalModel::energy_slope(const Deflection& at, const Vec3& d,
                                const Vec3& anchor_rate) const noexcept {
  const Element& e = surface_->element(point_.element);
  Vec3 turn{};
  double change_of_curves = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    const double rate = dot(e.gradient[l], d);
    const NodeCurves& node = response_.node(l);
    turn = turn + rate * surface_->inward(e, l);
    const double w = node.coupled() ? node.coupling().evaluate_from_start(at.depth).force : 1.0;
    change_of_curves += rate * (node.normal().evaluate(at.depth).energy +
                                w * node.lateral().evaluate(at.lateral).energy);
  }
  turn = (1.0 / norm(surface_->direction_sum(point_))) * (turn - dot(turn, n_) * n_);
  const LocalResponse response = respond(at);
  const Vec3 lateral = at.lateral * at.tangent + lateral_offset_;
  return change_of_curves + response.normal_force * (dot(lateral, turn) - dot(n_, d)) -
         response.lateral_force *
             (dot(at.tangent, anchor_rate) + at.geometric * dot(at.tangent, turn));
}

}  // namespace palpate::runtime
