// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/lean.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fitting/response/site_samples.hpp"

namespace palpate::fitting {
namespace {

constexpr double kLightTouch = 0.02;  // of the largest normal force: weights grow no further below
constexpr int kSections = 32;         // golden sections of the length of a lean
constexpr int kSteps = 64;            // of a press
constexpr double kLeastSpan = 0.01;   // of squared forces across the strongest drags, to theirs

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

/// Where a function of the length is least, by golden sections of [0, longest].
template <class Function>
double least(const Function& function, double longest) {
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double low = 0, high = longest;
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

/// w of a node at a depth; 1 where responses are decoupled.
double weight_of(const runtime::CompiledCurve& coupling, double z) {
  if (coupling.pieces().empty()) return 1;
  return coupling.weight(z);
}

runtime::CompiledCurve coupling_of(const NodeResponse& node, ResponseKind kind) {
  if (kind == ResponseKind::Decoupled) return {};
  return {node.coupling.curve, static_cast<double>(node.coupling.base)};
}

/// The drags at one lateral depth, over the normal force there: rows w f_t and f_n, changes of the
/// force since the start, and |f_t|^2.
struct DragsAtDepth {
  std::vector<Vec3> sheared;
  std::vector<double> normal, square;

  /// Takes out of the rows what is proportional to the square of the force.
  void remove_square() {
    double squares = 0, of_normal = 0;
    Vec3 of_sheared{};
    for (std::size_t i = 0; i < square.size(); ++i) {
      squares += square[i] * square[i];
      of_normal += square[i] * normal[i];
      of_sheared = of_sheared + square[i] * sheared[i];
    }
    if (!(squares > 0)) return;
    for (std::size_t i = 0; i < square.size(); ++i) {
      normal[i] -= square[i] * of_normal / squares;
      sheared[i] = sheared[i] - (square[i] / squares) * of_sheared;
    }
  }
};

std::vector<DragsAtDepth> drags_of(const SiteCurves& site, const Vec3& inward,
                                   const runtime::CompiledCurve& coupling) {
  std::vector<DragsAtDepth> drags;
  for (const double depth : lateral_depths(site)) {
    DragsAtDepth at;
    for (const CurvePath& path : paths_at(site, depth).paths) {
      if (path.samples.empty()) continue;
      const CurveSample& start = path.samples.front();
      const double pressed = dot(start.force, inward);
      if (start.displacement > 0 || !(pressed > 0)) continue;
      for (const CurveSample& sample : path.samples) {
        if (!(sample.displacement > 0)) continue;
        const Vec3 change = (1 / pressed) * (sample.force - start.force);
        const double normal = dot(change, inward);
        const Vec3 across = change - normal * inward;
        at.normal.push_back(normal);
        at.sheared.push_back(weight_of(coupling, depth) * across);
        at.square.push_back(dot(across, across));
      }
    }
    drags.push_back(std::move(at));
  }
  return drags;
}

}  // namespace

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

namespace {

/// The lean of straight presses, at most this long.
Vec3 lean_of_presses(const SiteCurves& site, const Vec3& inward, const NodeResponse& node,
                     ResponseKind kind, double longest) {
  const std::vector<Press> presses = presses_of(site, inward);
  const Vec3 direction = direction_of(presses);
  if (direction == Vec3{}) return {};
  const auto function = [&](double s) { return misfit(presses, node, kind, s * direction); };
  return least(function, longest) * direction;
}

}  // namespace

std::optional<Vec3> lean_of_drags(const SiteCurves& site, const Vec3& inward,
                                  const NodeResponse& node, ResponseKind kind) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (DragsAtDepth& at : drags_of(site, inward, coupling_of(node, kind))) {
    at.remove_square();
    for (std::size_t i = 0; i < at.normal.size(); ++i) {
      const Eigen::Map<const Eigen::Vector3d> row(at.sheared[i].data());
      squares += row * row.transpose();
      right -= at.normal[i] * row;
    }
  }
  // Across the press two of three directions are to be known; along it there is no shear.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(squares);
  const Eigen::Vector3d& strength = eigen.eigenvalues();  // ascending
  if (!(strength[2] > 0 && strength[1] > kLeastSpan * strength[2])) return std::nullopt;
  Eigen::Vector3d lean = Eigen::Vector3d::Zero();
  for (const int i : {1, 2})
    lean += eigen.eigenvectors().col(i).dot(right) / strength[i] * eigen.eigenvectors().col(i);
  const Vec3 sigma{lean[0], lean[1], lean[2]};
  return sigma - dot(sigma, inward) * inward;
}

std::array<float, 3> fit_lean(const SiteCurves& site, const Vec3& inward, const NodeResponse& node,
                              ResponseKind kind, PressingTool tool) {
  const double w = kind == ResponseKind::Coupled ? node.coupling.largest() : 1;
  const double longest = kMostFittedLean / w;
  Vec3 lean{};
  if (const auto of_drags = lean_of_drags(site, inward, node, kind))
    lean = *of_drags;
  else if (tool == PressingTool::Sticks)
    lean = lean_of_presses(site, inward, node, kind, longest);
  const double length = norm(lean);
  if (length > longest) lean = (longest / length) * lean;
  return w * length >= kLeastLean ? single(lean) : std::array<float, 3>{};
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
