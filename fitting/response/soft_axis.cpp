// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/soft_axis.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "fitting/response/site_samples.hpp"

namespace palpate::fitting {
namespace {

constexpr double kLeastSpanOfDrags = 0.01;  // of the weaker direction of the drags, to the stronger
constexpr double kSameAxis = 1 + 1e-9;

/// Two unit vectors across a press direction, as columns.
Eigen::Matrix<double, 3, 2> plane_across(const Vec3& inward) {
  const Eigen::Vector3d n(inward.data());
  const Eigen::Vector3d first = n.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> plane;
  plane << first, n.cross(first);
  return plane;
}

/// The displacement that all drags of a depth reach, m.
double common_reach(const SiteCurves& drags) {
  double reach = std::numeric_limits<double>::infinity();
  for (const CurvePath& path : drags.paths)
    if (!path.samples.empty()) reach = std::min(reach, path.samples.back().displacement);
  return reach;
}

/// K of the drags at one lateral depth over its trace, in the plane; zero where they do not tell.
Eigen::Matrix2d stiffness_of(const SiteCurves& drags, const Eigen::Matrix<double, 3, 2>& plane) {
  const double reach = common_reach(drags);
  // Unknown are K_00, K_11, K_01 = K_10: two rows for each sample.
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  Eigen::Matrix2d span = Eigen::Matrix2d::Zero();
  for (const CurvePath& path : drags.paths) {
    if (path.samples.empty() || path.samples.front().displacement > 0) continue;
    const Eigen::Vector2d e =
        plane.transpose() * Eigen::Map<const Eigen::Vector3d>(path.direction.data());
    for (const CurveSample& sample : path.samples) {
      const double d = sample.displacement;
      if (!(d > 0 && d <= kSameAxis * reach)) continue;
      const Vec3 change = (1 / d) * (sample.force - path.samples.front().force);
      const Eigen::Vector2d force =
          plane.transpose() * Eigen::Map<const Eigen::Vector3d>(change.data());
      Eigen::Matrix<double, 2, 3> rows;
      rows << e[0], 0, e[1], 0, e[1], e[0];
      squares += rows.transpose() * rows;
      right += rows.transpose() * force;
      span += e * e.transpose();
    }
  }
  const Eigen::Vector2d strength =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(span).eigenvalues();
  if (!(strength[0] > kLeastSpanOfDrags * strength[1])) return Eigen::Matrix2d::Zero();
  const Eigen::Vector3d k = squares.ldlt().solve(right);
  Eigen::Matrix2d stiffness;
  stiffness << k[0], k[2], k[2], k[1];
  if (!(stiffness.trace() > 0 && stiffness.determinant() > 0)) return Eigen::Matrix2d::Zero();
  return stiffness / stiffness.trace();
}

}  // namespace

std::array<float, 3> fit_soft_axis(const SiteCurves& site, const Vec3& inward) {
  const Eigen::Matrix<double, 3, 2> plane = plane_across(inward);
  Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();
  for (const double depth : lateral_depths(site))
    stiffness += stiffness_of(paths_at(site, depth), plane);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(stiffness);
  const double soft = eigen.eigenvalues()[0], stiff = eigen.eigenvalues()[1];
  if (!(soft > 0)) return {};
  const double length = std::sqrt(1 - std::sqrt(soft / stiff));
  if (!(length >= kLeastSoftAxis)) return {};
  const Eigen::Vector3d axis =
      std::min(length, kMostFittedSoftAxis) * (plane * eigen.eigenvectors().col(0));
  return {static_cast<float>(axis[0]), static_cast<float>(axis[1]), static_cast<float>(axis[2])};
}

std::vector<SoftDrag> soft_drags(const SiteCurves& site, const Vec3& soft_axis) {
  std::vector<SoftDrag> drags;
  for (const CurvePath& path : site.paths) {
    SiteCurves one;
    one.paths.push_back(path);
    const double stretch = soft_axis == Vec3{} ? 1 : norm(stretched(soft_axis, path.direction));
    for (auto& samples : lateral_paths(one)) drags.push_back({stretch, std::move(samples)});
  }
  return drags;
}

std::vector<ForceSample> along_stiffest(const SoftDrag& drag,
                                        const runtime::CompiledCurve& lateral) {
  std::vector<ForceSample> samples = drag.samples;
  const double u = drag.stretch;
  if (u == 1) return samples;
  const auto quotient = [u](double stiffest, double soft) {
    return soft > 0 ? stiffest / soft : 1 / (u * u);
  };
  for (ForceSample& sample : samples) {
    const double d = sample.displacement, since = sample.since;
    sample.force *= quotient(lateral.force(d), u * lateral.force(u * d));
    sample.mean *= quotient(lateral.energy(d) - lateral.energy(since),
                            lateral.energy(u * d) - lateral.energy(u * since));
  }
  return samples;
}

std::vector<std::vector<ForceSample>> along_stiffest(const std::vector<SoftDrag>& drags,
                                                     const runtime::CompiledCurve& lateral) {
  std::vector<std::vector<ForceSample>> paths;
  for (const SoftDrag& drag : drags) paths.push_back(along_stiffest(drag, lateral));
  return paths;
}

}  // namespace palpate::fitting
