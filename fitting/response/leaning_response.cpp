// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/leaning_response.hpp"

#include <algorithm>

namespace palpate::fitting {
namespace {

constexpr int kSteps = 64;  // of a press

}  // namespace

runtime::CompiledCurve coupling_of(const NodeResponse& node, ResponseKind kind) {
  if (kind == ResponseKind::Decoupled) return {};
  return {node.coupling.curve, static_cast<double>(node.coupling.base)};
}

LeaningResponse::LeaningResponse(const NodeResponse& node, ResponseKind kind)
    : lateral_(node.lateral), coupling_(coupling_of(node, kind)) {
  soft_axis_ = vec3_of(node.soft_axis);
  lean_ = vec3_of(node.lean);
  stretched_lean_ = stretch(lean_);
  length_ = norm(stretched_lean_);
}

runtime::CurveValue LeaningResponse::weight(double z) const {
  if (coupling_.pieces().empty()) return {1, 0, 0};
  if (!(z > 0)) return {coupling_.weight(0), 0, 0};
  return coupling_.evaluate(z);
}

/// d|p|/dz = w |S sigma| - (w'/w) h/h': the force w h grows with the lateral deflection alone.
double LeaningResponse::lateral_rate(double z, double lateral) const {
  const runtime::CurveValue w = weight(z), h = lateral_.evaluate(lateral);
  if (!(h.slope > 0)) return w.force * length_;
  return w.force * length_ - w.slope / w.force * h.force / h.slope;
}

/// By the method of Heun.
LeaningResponse::Press LeaningResponse::press(double z) const {
  Press at;
  if (!(length_ > 0 && z > 0)) return at;
  const double step = z / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const double start = k * step, end = start + step;
    const double before = weight(start).force * at.force;
    const double rate = lateral_rate(start, at.lateral);
    const double guess = std::max(0.0, at.lateral + step * rate);
    at.lateral += 0.5 * step * (rate + lateral_rate(end, guess));
    at.lateral = std::max(0.0, at.lateral);
    const double w = weight(end).force;
    at.force = w * lateral_.force(at.lateral);
    at.energy += 0.5 * step * length_ * (before + w * at.force);
  }
  return at;
}

double LeaningResponse::energy(double z) const {
  return press(z).energy;
}

double LeaningResponse::normal_force(double z) const {
  return length_ * weight(z).force * press(z).force;
}

Vec3 LeaningResponse::transverse_force(double z) const {
  if (!(length_ > 0)) return {};
  return (-press(z).force / length_) * stretch(stretched_lean_);
}

double LeaningResponse::drag_force(double z, double d, const Vec3& direction) const {
  const Press at = press(z);
  const Vec3 before = length_ > 0 ? (-at.lateral / length_) * stretched_lean_ : Vec3{};
  const Vec3 along = stretch(direction);
  const Vec3 p = before + d * along;
  const double rho = norm(p);
  const double dragged = rho > 0 ? weight(z).force * lateral_.force(rho) * dot(p, along) / rho : 0;
  const double leaning = at.lateral > 0 ? at.force * dot(before, along) / at.lateral : 0;
  return dragged - leaning;
}

}  // namespace palpate::fitting
