// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/lean.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fitting/response/site_samples.hpp"
#include "format/tangent_frame.hpp"

namespace palpate::fitting {
namespace {

constexpr double kLightTouch = 0.02;  // of the largest normal force: weights grow no further below
constexpr int kGaussNewtonSteps = 6;  // the forces are almost linear in the lean
constexpr double kDifference = 1e-3;  // of leans, for the derivatives
constexpr double kLeastSpan = 0.01;   // of squared forces across the strongest drags, to theirs

/// A sample of a straight press.
struct Press {
  double depth = 0;
  Vec3 transverse{};  ///< N, since the first sample
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
  // What touches within an increment is tied where it would touch without friction. In the first
  // one all of the contact does, so that half of the shear can be missing.
  const Vec3 first = presses.empty() ? Vec3{} : presses.front().transverse;
  for (Press& press : presses) {
    press.transverse = press.transverse - first;
    const double scale = std::max(press.weight, kLightTouch * largest);
    press.weight = 1 / (scale * scale);
  }
  return presses;
}

std::array<float, 3> single(const Vec3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// The transverse forces of straight presses with that lean, since the first.
std::vector<Vec3> transverse_forces(const std::vector<Press>& presses, NodeResponse node,
                                    ResponseKind kind, const Vec3& lean) {
  node.lean = single(lean);
  const LeaningResponse response(node, kind);
  std::vector<Vec3> forces;
  forces.reserve(presses.size());
  for (const Press& press : presses)
    forces.push_back(response.transverse_force(press.depth) -
                     response.transverse_force(presses.front().depth));
  return forces;
}

/// w of a node at a depth; 1 where responses are decoupled.
double weight_of(const runtime::CompiledCurve& coupling, double z) {
  if (coupling.pieces().empty()) return 1;
  return coupling.weight(z);
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

/// Normal equations of a lean: squares . sigma = right.
struct LeanEquations {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

LeanEquations equations_of_drags(const SiteCurves& site, const Vec3& inward,
                                 const NodeResponse& node, ResponseKind kind) {
  LeanEquations equations;
  for (DragsAtDepth& at : drags_of(site, inward, coupling_of(node, kind))) {
    at.remove_square();
    for (std::size_t i = 0; i < at.normal.size(); ++i) {
      const Eigen::Map<const Eigen::Vector3d> row(at.sheared[i].data());
      equations.squares += row * row.transpose();
      equations.right -= at.normal[i] * row;
    }
  }
  return equations;
}

/// Absent where the equations leave one of the two directions across the press open; along it
/// there is no shear.
std::optional<Vec3> solved(const LeanEquations& equations, const Vec3& inward) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(equations.squares);
  const Eigen::Vector3d& strength = eigen.eigenvalues();  // ascending
  if (!(strength[2] > 0 && strength[1] > kLeastSpan * strength[2])) return std::nullopt;
  Eigen::Vector3d lean = Eigen::Vector3d::Zero();
  for (const int i : {1, 2})
    lean += eigen.eigenvectors().col(i).dot(equations.right) / strength[i] *
            eigen.eigenvectors().col(i);
  const Vec3 sigma{lean[0], lean[1], lean[2]};
  return sigma - dot(sigma, inward) * inward;
}

/// Adds those of the presses, linearised at a lean.
void add_presses(const std::vector<Press>& presses, const Vec3& inward, const NodeResponse& node,
                 ResponseKind kind, const Vec3& lean, LeanEquations& equations) {
  const auto here = transverse_forces(presses, node, kind, lean);
  const std::array<Vec3, 2> across = tangent_frame(inward);
  const Eigen::Map<const Eigen::Vector3d> sigma(lean.data());
  std::array<std::vector<Vec3>, 2> moved;
  for (std::size_t i = 0; i < 2; ++i)
    moved[i] = transverse_forces(presses, node, kind, lean + kDifference * across[i]);
  for (std::size_t k = 0; k < presses.size(); ++k) {
    Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 change = (1 / kDifference) * (moved[i][k] - here[k]);
      slope += Eigen::Map<const Eigen::Vector3d>(change.data()) *
               Eigen::Map<const Eigen::Vector3d>(across[i].data()).transpose();
    }
    const Vec3 missing = presses[k].transverse - here[k];
    equations.squares += presses[k].weight * slope.transpose() * slope;
    equations.right += presses[k].weight * slope.transpose() *
                       (Eigen::Map<const Eigen::Vector3d>(missing.data()) + slope * sigma);
  }
}

Vec3 at_most(double longest, const Vec3& lean) {
  const double length = norm(lean);
  return length > longest ? (longest / length) * lean : lean;
}

/// The lean of the presses of a tool that sticks, and of the drags where they tell it, by the
/// Gauss-Newton method.
Vec3 lean_of_presses(const SiteCurves& site, const Vec3& inward, const NodeResponse& node,
                     ResponseKind kind, double longest) {
  const std::vector<Press> presses = presses_of(site, inward);
  LeanEquations drags = equations_of_drags(site, inward, node, kind);
  const auto of_drags = solved(drags, inward);
  if (!of_drags) drags = {};
  Vec3 lean = at_most(longest, of_drags.value_or(Vec3{}));
  for (int i = 0; i < kGaussNewtonSteps; ++i) {
    LeanEquations all = drags;
    add_presses(presses, inward, node, kind, lean, all);
    const auto better = solved(all, inward);
    if (!better) return lean;
    lean = at_most(longest, *better);
  }
  return lean;
}

}  // namespace

std::optional<Vec3> lean_of_drags(const SiteCurves& site, const Vec3& inward,
                                  const NodeResponse& node, ResponseKind kind) {
  return solved(equations_of_drags(site, inward, node, kind), inward);
}

std::array<float, 3> fit_lean(const SiteCurves& site, const Vec3& inward, const NodeResponse& node,
                              ResponseKind kind, PressingTool tool) {
  const double w = kind == ResponseKind::Coupled ? node.coupling.largest() : 1;
  const double longest = kMostFittedLean / w;
  const Vec3 lean =
      tool == PressingTool::Sticks
          ? lean_of_presses(site, inward, node, kind, longest)
          : at_most(longest, lean_of_drags(site, inward, node, kind).value_or(Vec3{}));
  return w * norm(lean) >= kLeastLean ? single(lean) : std::array<float, 3>{};
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
