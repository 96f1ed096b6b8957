// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/lean.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpate::fitting {
namespace {

constexpr double kLightTouch = 0.02;  // of the largest normal force: weights grow no further below
constexpr int kSections = 32;         // golden sections of the length of a lean
constexpr int kSteps = 64;            // of a press

/// A sample of a straight press.
struct Press {
  double depth = 0;
  Vec3 transverse{};  ///< N
  double weight = 0;  ///< 1/N^2: differences count relative to the normal force
};

std::vector<Press> presses_of(const SiteCurves& site, const Vec3& inward) {
  std::vector<Press> presses;
  double largest = 0;
  for (const CurvePath& path : site.paths) {
    if (path.kind != PathKind::Normal) continue;
    for (const CurveSample& sample : path.samples) {
      const double normal = dot(sample.force, inward);
      if (!(sample.displacement > 0 && normal > 0)) continue;
      presses.push_back({sample.displacement, sample.force - normal * inward, normal});
      largest = std::max(largest, normal);
    }
  }
  for (Press& press : presses) {
    const double scale = std::max(press.weight, kLightTouch * largest);
    press.weight = 1 / (scale * scale);
  }
  return presses;
}

/// Against the mean of the transverse forces; zero without any.
Vec3 direction_of(const std::vector<Press>& presses) {
  Vec3 sum{};
  for (const Press& press : presses) sum = sum - std::sqrt(press.weight) * press.transverse;
  const double length = norm(sum);
  return length > 0 ? (1 / length) * sum : Vec3{};
}

std::array<float, 3> single(const Vec3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

double misfit(const std::vector<Press>& presses, NodeResponse node, ResponseKind kind,
              const Vec3& lean) {
  node.lean = single(lean);
  const LeaningResponse response(node, kind);
  double sum = 0;
  for (const Press& press : presses) {
    const Vec3 difference = response.transverse_force(press.depth) - press.transverse;
    sum += press.weight * dot(difference, difference);
  }
  return sum;
}

/// Least value of a function of the length by golden sections of [0, kMostFittedLean].
template <class Function>
double least(const Function& function) {
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double low = 0, high = kMostFittedLean;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double at_a = function(a), at_b = function(b);
  for (int i = 0; i < kSections; ++i) {
    if (at_a <= at_b) {
      high = b;
      b = a;
      at_b = at_a;
      at_a = function(a = high - ratio * (high - low));
    } else {
      low = a;
      a = b;
      at_a = at_b;
      at_b = function(b = low + ratio * (high - low));
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

LeaningResponse::LeaningResponse(const NodeResponse& node, ResponseKind kind)
    : lateral_(node.lateral) {
  for (std::size_t i = 0; i < 3; ++i) lean_[i] = static_cast<double>(node.lean[i]);
  length_ = norm(lean_);
  if (kind == ResponseKind::Coupled)
    coupling_ = {node.coupling.curve, static_cast<double>(node.coupling.base)};
}

runtime::CurveValue LeaningResponse::weight(double z) const {
  if (coupling_.pieces().empty()) return {1, 0, 0};
  if (!(z > 0)) return {coupling_.pieces().front().force, 0, 0};
  return coupling_.evaluate(z);
}

/// d|q|/dz = |sigma| - (w'/w) h/h': the force w h grows with the lateral deflection alone.
double LeaningResponse::lateral_rate(double z, double lateral) const {
  const runtime::CurveValue w = weight(z), h = lateral_.evaluate(lateral);
  if (!(h.slope > 0)) return length_;
  return length_ - w.slope / w.force * h.force / h.slope;
}

/// By the method of Heun.
LeaningResponse::Press LeaningResponse::press(double z) const {
  Press at;
  if (!(length_ > 0 && z > 0)) return at;
  const double step = z / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const double start = k * step, end = start + step, before = at.force;
    const double rate = lateral_rate(start, at.lateral);
    const double guess = std::max(0.0, at.lateral + step * rate);
    at.lateral += 0.5 * step * (rate + lateral_rate(end, guess));
    at.lateral = std::max(0.0, at.lateral);
    at.force = weight(end).force * lateral_.force(at.lateral);
    at.energy += 0.5 * step * length_ * (before + at.force);
  }
  return at;
}

double LeaningResponse::energy(double z) const {
  return press(z).energy;
}

double LeaningResponse::normal_force(double z) const {
  return length_ * press(z).force;
}

Vec3 LeaningResponse::transverse_force(double z) const {
  if (!(length_ > 0)) return {};
  return (-press(z).force / length_) * lean_;
}

double LeaningResponse::drag_force(double z, double d, const Vec3& direction) const {
  const Press at = press(z);
  const Vec3 before = length_ > 0 ? (-at.lateral / length_) * lean_ : Vec3{};
  const Vec3 q = before + d * direction;
  const double rho = norm(q);
  const double along = rho > 0 ? dot(q, direction) / rho : 0;
  const double leaning = at.lateral > 0 ? at.force * dot(before, direction) / at.lateral : 0;
  return weight(z).force * lateral_.force(rho) * along - leaning;
}

std::array<float, 3> fit_lean(const SiteCurves& site, const Vec3& inward, const NodeResponse& node,
                              ResponseKind kind) {
  const std::vector<Press> presses = presses_of(site, inward);
  const Vec3 direction = direction_of(presses);
  if (direction == Vec3{}) return {};
  const double length = least([&](double s) { return misfit(presses, node, kind, s * direction); });
  return length >= kLeastLean ? single(length * direction) : std::array<float, 3>{};
}

/// The mean of the force is the change of the energy over the travel.
std::vector<ForceSample> less_lean(std::vector<ForceSample> samples, const LeaningResponse& lean) {
  for (ForceSample& sample : samples) {
    const double z = sample.displacement;
    sample.force -= lean.normal_force(z);
    sample.mean -= (lean.energy(z) - lean.energy(sample.since)) / (z - sample.since);
  }
  return samples;
}

}  // namespace palpate::fitting
