// SPDX-License-Identifier: Apache-2.0
#include "runtime/local_model.hpp"

#include <cstddef>

namespace palpate::runtime {

double LocalModel::energy(const Deflection& d) const noexcept {
  return respond(d).energy;
}

double LocalModel::slip_limit(const Deflection& d, double friction) const noexcept {
  return response_.lateral_inverse(friction * response_.normal(d.depth).force,
                                   response_.lateral_weights(d.depth));
}

double LocalModel::energy_slope(const Deflection& at, const Vec3& d) const noexcept {
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
  const double g = response.normal_force;
  const double h = response.lateral_force;
  const double tilt = dot(at.tangent, turn);
  return change_of_curves + (g * at.lateral - h * at.depth) * tilt - g * dot(n_, d) -
         h * dot(at.tangent, d) - offset_ * h * tilt;
}

}  // namespace palpate::runtime
