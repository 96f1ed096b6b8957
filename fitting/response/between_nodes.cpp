// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/between_nodes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <set>

#include "fitting/response/neighbours.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr Eigen::Index kTerms = 6;      // of a quadratic on a plane
constexpr double kSameSide = 0.5;       // cosine between press directions on one side of an edge
constexpr double kMaxCorrection = 0.2;  // relative; patches that need more are too coarse

Eigen::Vector3d to_eigen(const Vec3& v) {
  return Eigen::Vector3d(v.data());
}

using Rings = std::vector<std::set<std::size_t>>;

/// Vertices with a force in two rings around a vertex, on its side of sharp edges.
std::vector<std::size_t> around(const Library& library, const Rings& rings,
                                const std::vector<double>& force, std::size_t vertex) {
  std::set<std::size_t> found;
  for (const std::size_t near : rings[vertex])
    for (const std::size_t other : rings[near])  // includes the vertex
      if (force[other] > 0 && dot(library.inward[other], library.inward[vertex]) > kSameSide)
        found.insert(other);
  return {found.begin(), found.end()};
}

/// Hessian of the force along the surface, N/m^2; zero where it cannot be determined.
Eigen::Matrix3d hessian(const Library& library, const Rings& rings,
                        const std::vector<double>& force, std::size_t vertex) {
  const std::vector<std::size_t> near = around(library, rings, force, vertex);
  const auto count = static_cast<Eigen::Index>(near.size());
  if (count < kTerms) return Eigen::Matrix3d::Zero();
  const Eigen::Vector3d inward = to_eigen(library.inward[vertex]);
  const Eigen::Vector3d e1 = inward.unitOrthogonal(), e2 = inward.cross(e1);
  double reach = 0;
  for (const std::size_t j : near)
    reach = std::max(reach, norm(library.positions[j] - library.positions[vertex]));
  Eigen::MatrixXd A(count, kTerms);
  Eigen::VectorXd b(count);
  for (Eigen::Index row = 0; row < count; ++row) {
    const std::size_t j = near[static_cast<std::size_t>(row)];
    const Eigen::Vector3d d = to_eigen(library.positions[j] - library.positions[vertex]) / reach;
    Eigen::Vector2d flat(d.dot(e1), d.dot(e2));
    if (flat.norm() > 0) flat *= d.norm() / flat.norm();  // unrolled: keeps the distance
    const double weight = 1 / std::max(d.norm(), 0.25);
    A.row(row) << 1, flat[0], flat[1], 0.5 * flat[0] * flat[0], flat[0] * flat[1],
        0.5 * flat[1] * flat[1];
    A.row(row) *= weight;
    b[row] = weight * force[j];
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  if (qr.rank() < kTerms) return Eigen::Matrix3d::Zero();
  const Eigen::VectorXd c = qr.solve(b) / (reach * reach);
  return c[3] * e1 * e1.transpose() + c[4] * (e1 * e2.transpose() + e2 * e1.transpose()) +
         c[5] * e2 * e2.transpose();
}

/// m of a triangle: mean excess of linear interpolation, N.
double mean_excess(const Library& library, const Triangle& triangle,
                   const std::vector<Eigen::Matrix3d>& hessians) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto a = static_cast<std::size_t>(triangle[k]);
    const auto b = static_cast<std::size_t>(triangle[(k + 1) % 3]);
    const Eigen::Vector3d edge = to_eigen(library.positions[b] - library.positions[a]);
    sum += edge.dot(0.5 * (hessians[a] + hessians[b]) * edge) / 24;
  }
  return sum;
}

double area(const Library& library, const Triangle& triangle) {
  const auto corner = [&](std::size_t k) {
    return to_eigen(library.positions[static_cast<std::size_t>(triangle[k])]);
  };
  return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
}

}  // namespace

std::vector<double> factors_between_nodes(const Library& library, double depth) {
  const std::size_t vertices = library.positions.size();
  std::vector<double> force(vertices, 0.0);
  for (std::size_t v = 0; v < vertices; ++v)
    if (library.responses[v].status != ResponseStatus::Hole)
      force[v] = runtime::CompiledCurve(library.responses[v].normal).force(depth);
  const Rings rings = neighbours_of(library);
  std::vector<Eigen::Matrix3d> hessians(vertices, Eigen::Matrix3d::Zero());
  for (std::size_t v = 0; v < vertices; ++v)
    if (force[v] > 0) hessians[v] = hessian(library, rings, force, v);
  std::vector<double> excess(vertices, 0.0), around(vertices, 0.0);
  for (const Triangle& triangle : library.triangles) {
    const double weight = area(library, triangle);
    const double mean = mean_excess(library, triangle, hessians);
    for (const std::int32_t corner : triangle) {
      excess[static_cast<std::size_t>(corner)] += weight * mean;
      around[static_cast<std::size_t>(corner)] += weight;
    }
  }
  std::vector<double> factors(vertices, 1.0);
  for (std::size_t v = 0; v < vertices; ++v)
    if (force[v] > 0 && around[v] > 0)
      factors[v] -= std::clamp(excess[v] / around[v] / force[v], -kMaxCorrection, kMaxCorrection);
  return factors;
}

}  // namespace palpate::fitting
