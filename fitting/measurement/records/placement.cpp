// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/placement.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::measured {
namespace {

Eigen::Vector3d to_eigen(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

Registration register_fiducials(const std::vector<Fiducial>& fiducials, const std::string& where) {
  const auto refuse = [&](const char* problem) {
    throw Error(ErrorKind::Configuration, where, problem,
                "give at least three points that do not lie on one line, well apart");
  };
  if (fiducials.size() < 3) refuse("fewer than three fiducials are given");
  Eigen::Vector3d robot_mean = Eigen::Vector3d::Zero(), body_mean = Eigen::Vector3d::Zero();
  for (const Fiducial& f : fiducials) {
    robot_mean += to_eigen(f.robot) / static_cast<double>(fiducials.size());
    body_mean += to_eigen(f.body) / static_cast<double>(fiducials.size());
  }
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (const Fiducial& f : fiducials) {
    H += (to_eigen(f.robot) - robot_mean) * (to_eigen(f.body) - body_mean).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[1] < 1e-6 * svd.singularValues()[0]) {
    refuse("the fiducials lie on one line");
  }
  // The nearest orthogonal matrix that is no reflection.
  Eigen::Vector3d sign(1, 1,
                       (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1);
  const Eigen::Matrix3d R = svd.matrixV() * sign.asDiagonal() * svd.matrixU().transpose();
  const Eigen::Vector3d t = body_mean - R * robot_mean;
  Registration result;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    result.motion.rows[row] = {R(i, 0), R(i, 1), R(i, 2)};
    result.motion.translation[row] = t[i];
  }
  double squares = 0;
  for (const Fiducial& f : fiducials) {
    const Vec3 miss = result.motion(f.robot) - f.body;
    squares += dot(miss, miss);
  }
  result.rms = std::sqrt(squares / static_cast<double>(fiducials.size()));
  return result;
}

NearestSite nearest_site(const Body& body, const Vec3& point, double tolerance,
                         const std::string& where) {
  NearestSite nearest;
  const ResponseSurface& surface = body.response;
  for (std::size_t v = 0; v < surface.node.size(); ++v) {
    if (surface.is_site[v] == 0) continue;
    const double distance = norm(body.nodes[static_cast<std::size_t>(surface.node[v])] - point);
    if (nearest.vertex >= 0 && distance >= nearest.distance) continue;
    nearest = {static_cast<int>(v), distance};
  }
  if (nearest.vertex < 0) {
    throw Error(ErrorKind::Configuration, body.name, "the body has no site",
                "shrink the supports so that some response vertices stay free");
  }
  if (nearest.distance > tolerance) {
    throw Error(ErrorKind::Configuration, where,
                "the nearest site, vertex " + std::to_string(nearest.vertex) + ", is " +
                    length_text(nearest.distance) + " away",
                "check the frame and the units of the points, or raise the tolerance (" +
                    length_text(tolerance) + ")");
  }
  return nearest;
}

}  // namespace palpate::measured
