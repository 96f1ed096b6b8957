// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/rigid_motion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace palpate::fem {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Rotation of a step, rad, from which it is applied as one: below, its second order is negligible
/// beside the strains under a tool.
constexpr double kSmallestRotation = 2e-3;

/// Mean position of the nodes that are fixed or on springs.
Vector3d middle_of_support(const QuadraticMesh& mesh, const Displacement& u) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  const auto add = [&](int node) {
    sum += mesh.X.col(node) + u.col(node);
    ++count;
  };
  for (int node = 0; node < mesh.nodes(); ++node)
    if (mesh.fixed[to_index(node)]) add(node);
  for (const SprungFacet& sprung : mesh.sprung)
    for (const auto node : mesh.facets[to_index(sprung.facet)]) add(node);
  return count > 0 ? Vector3d(sum / count) : sum;
}

/// The w of the least-squares fit of v + w x x to the steps d of the free nodes.
Vector3d rotation_of_step(const SolidModel& model, const Eigen::VectorXd& d,
                          const Displacement& u) {
  const QuadraticMesh& mesh = model.mesh();
  Vector3d x_mean = Vector3d::Zero(), d_mean = Vector3d::Zero();
  int count = 0;
  for (int node = 0; node < mesh.nodes(); ++node) {
    if (model.equation(node) < 0) continue;
    x_mean += mesh.X.col(node) + u.col(node);
    d_mean += d.segment<3>(model.equation(node));
    ++count;
  }
  x_mean /= count;
  d_mean /= count;
  Matrix3d inertia = Matrix3d::Zero();
  Vector3d moment = Vector3d::Zero();
  for (int node = 0; node < mesh.nodes(); ++node) {
    if (model.equation(node) < 0) continue;
    const Vector3d r = mesh.X.col(node) + u.col(node) - x_mean;
    inertia += r.squaredNorm() * Matrix3d::Identity() - r * r.transpose();
    moment += r.cross(d.segment<3>(model.equation(node)) - d_mean);
  }
  return inertia.ldlt().solve(moment);
}

}  // namespace

Matrix3d nearest_rotation(const Matrix3d& matrix) {
  const Eigen::JacobiSVD<Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Matrix3d mean_rotation(const QuadraticMesh& mesh, const Displacement& u) {
  const Vector3d X_mean = mesh.X.rowwise().mean(), u_mean = u.rowwise().mean();
  Matrix3d covariance = Matrix3d::Zero();
  for (int node = 0; node < mesh.nodes(); ++node) {
    const Vector3d R = mesh.X.col(node) - X_mean;
    covariance += (R + u.col(node) - u_mean) * R.transpose();
  }
  return nearest_rotation(covariance);
}

void add_rotating_step(const SolidModel& model, double s, const Eigen::VectorXd& d,
                       Displacement& u) {
  const QuadraticMesh& mesh = model.mesh();
  const Vector3d w = s * rotation_of_step(model, d, u);
  const double angle = w.norm();
  if (angle < kSmallestRotation) return add_step(model, s, d, u);
  const Matrix3d rotation = Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
  const Vector3d c = middle_of_support(mesh, u);
  for (int node = 0; node < mesh.nodes(); ++node) {
    if (model.equation(node) < 0) continue;
    const Vector3d r = mesh.X.col(node) + u.col(node) - c;
    const Vector3d step = s * d.segment<3>(model.equation(node)), along = w.cross(r);
    u.col(node) += step - along + rotation * r - r;
  }
  straighten(mesh, u);
}

}  // namespace palpate::fem
