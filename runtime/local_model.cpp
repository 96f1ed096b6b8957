// SPDX-License-Identifier: Apache-2.0
#include "runtime/local_model.hpp"

#include <cstddef>

namespace palpate::runtime {

double LocalModel::energy(const Deflection& d) const noexcept {
  return response_.normal(d.depth).energy + response_.lateral(d.lateral).energy;
}

double LocalModel::slip_limit(const Deflection& d, double friction) const noexcept {
  return response_.lateral_inverse(friction * response_.normal(d.depth).force);
}

double LocalModel::energy_slope(const Deflection& at, const Vec3& d) const noexcept {
  const Element& e = surface_->element(point_.element);
  Vec3 turn{};
  double change_of_curves = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    const double rate = dot(e.gradient[l], d);
    const NodeCurves& node = response_.node(l);
    turn = turn + rate * surface_->inward(e, l);
    change_of_curves += rate * (node.normal().evaluate(at.depth).energy +
                                node.lateral().evaluate(at.lateral).energy);
  }
  turn = (1.0 / norm(surface_->direction_sum(point_))) * (turn - dot(turn, n_) * n_);
  const double g = response_.normal(at.depth).force;
  const double h = response_.lateral(at.lateral).force;
  const double tilt = dot(at.tangent, turn);
  return change_of_curves + (g * at.lateral - h * at.depth) * tilt - g * dot(n_, d) -
         h * dot(at.tangent, d) - offset_ * h * tilt;
}

}  // namespace palpate::runtime
