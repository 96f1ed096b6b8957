// SPDX-License-Identifier: Apache-2.0
#include "runtime/local_model.hpp"

#include <cstddef>

namespace palpate::runtime {

double LocalModel::energy(const Deflection& d) const noexcept {
  return respond(d).energy;
}

void LocalModel::replace_memory(const NormalMemory& memory, LocalResponse& at) noexcept {
  set_memory(memory);
  const RelaxedResponse before = at.relaxed;
  at.relaxed = relaxed_response(memory, before.instant);
  const double change = at.relaxed.force - before.force;
  at.normal_force += change;
  at.friction_normal_force = at.relaxed.force;
  at.force = at.force + change * n_;
  at.energy += at.relaxed.energy - before.energy;
  at.at_depth.friction_normal_force = at.relaxed.force;
  at.at_depth.energy = at.relaxed.energy;
}

void LocalModel::slip_to(double rho, Deflection& d, LocalResponse& at,
                         PiecesInUse& pieces) noexcept {
  set_lateral_offset(lateral_offset_ + (d.lateral - rho) * d.tangent);
  d.lateral = rho;
  if (!(rho > 0)) d.tangent = {};
  if (coupled()) {
    respond_at_depth(d, pieces, at);
  } else {
    at = respond(d, pieces);
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
