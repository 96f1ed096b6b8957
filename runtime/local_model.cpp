// SPDX-License-Identifier: Apache-2.0
#include "runtime/local_model.hpp"

#include <cstddef>

namespace palpate::runtime {

LocalModel::LocalModel(const Surface& surface, const SurfacePoint& point, double offset) noexcept
    : surface_(&surface),
      point_(point),
      c_(surface.position(point)),
      n_(surface.normal(point)),
      response_(surface.response(point)),
      offset_(offset) {}

Deflection LocalModel::deflection(const Vec3& x) const noexcept {
  Deflection d;
  const Vec3 r = x - c_;
  d.geometric = dot(n_, r);
  d.depth = d.geometric - offset_;
  const Vec3 lateral = r - d.geometric * n_;
  d.lateral = norm(lateral);
  if (d.lateral > 0) d.tangent = (1.0 / d.lateral) * lateral;
  return d;
}

LocalResponse LocalModel::respond(const Deflection& d) const noexcept {
  const CurveValue g = response_.normal(d.depth);
  const CurveValue h = response_.lateral(d.lateral);
  return {g.force, h.force, g.energy + h.energy, g.force * n_ + h.force * d.tangent};
}

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
    change_of_curves += rate * (node.normal.energy(at.depth) + node.lateral.energy(at.lateral));
  }
  turn = (1.0 / norm(surface_->direction_sum(point_))) * (turn - dot(turn, n_) * n_);
  const double g = response_.normal(at.depth).force;
  const double h = response_.lateral(at.lateral).force;
  const double tilt = dot(at.tangent, turn);
  return change_of_curves + (g * at.lateral - h * at.depth) * tilt - g * dot(n_, d) -
         h * dot(at.tangent, d) - offset_ * h * tilt;
}

}  // namespace palpate::runtime
