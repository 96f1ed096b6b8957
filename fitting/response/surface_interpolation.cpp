// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/surface_interpolation.hpp"
#include "format/tangent_frame.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate::fitting {
namespace {

constexpr double kLeastCosine =
    0.2;  // between press directions of vertices that may interpolate each other
constexpr std::size_t kDonors = 12;  // per spline: about two rings of neighbours
constexpr std::size_t kFewest = 5;   // fewer donors do not determine a spline

// The absolute weights of an interpolating spline have about this sum at most; those of an
// extrapolating one exceed it.
constexpr double kLargestWeights = 2.0;

struct Planar {
  double x = 0, y = 0;
};

double kernel(const Planar& a, const Planar& b) {
  const double r2 = (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
  return r2 > 0 ? 0.5 * r2 * std::log(r2) : 0;
}

/// Weights of the spline through the points for its value at the origin; empty when the points do
/// not span a plane. Unknowns of the dual problem: [K P; P^T 0] [w; c] = [k(0); 1, 0, 0].
std::vector<double> spline_weights(const std::vector<Planar>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 3, n + 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Planar& point = points[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j)
      system(i, j) = kernel(point, points[static_cast<std::size_t>(j)]);
    system.row(i).tail<3>() << 1, point.x, point.y;
    system.col(i).tail<3>() << 1, point.x, point.y;
    right(i) = kernel(point, {});
  }
  right(n) = 1;
  Eigen::FullPivLU<Eigen::MatrixXd> factors(system);
  factors.setThreshold(1e-8);
  if (!factors.isInvertible()) return {};
  const Eigen::VectorXd solution = factors.solve(right);
  return {solution.data(), solution.data() + n};
}

bool is_between(const std::vector<double>& weights) {
  if (weights.empty()) return false;
  double sum = 0;
  for (const double weight : weights) sum += std::abs(weight);
  return sum <= kLargestWeights;  // false for NaN
}

/// Inverse squared distances of the nearest four donors, whose `weight` is their distance.
std::vector<Donor> inverse_square_weights(std::vector<Donor> donors) {
  donors.resize(std::min<std::size_t>(4, donors.size()));
  double sum = 0;
  for (Donor& donor : donors) sum += donor.weight = 1 / (donor.weight * donor.weight);
  for (Donor& donor : donors) donor.weight /= sum;
  return donors;
}

}  // namespace

double interpolation_distance(const std::vector<Vec3>& positions, const std::vector<Vec3>& inward,
                              std::size_t a, std::size_t b) {
  const double cosine = dot(inward[a], inward[b]);
  if (cosine < kLeastCosine) return std::numeric_limits<double>::infinity();
  return norm(positions[a] - positions[b]) * (3 - 2 * std::min(cosine, 1.0));
}

SurfaceInterpolation::SurfaceInterpolation(const std::vector<Vec3>& positions,
                                           const std::vector<Vec3>& inward,
                                           std::vector<std::size_t> donors)
    : positions_(positions), inward_(inward), donors_(std::move(donors)) {}

std::vector<Donor> SurfaceInterpolation::nearest(std::size_t vertex, std::size_t count) const {
  std::vector<Donor> seen;
  for (const std::size_t donor : donors_) {
    const double distance = interpolation_distance(positions_, inward_, vertex, donor);
    if (donor != vertex && distance < std::numeric_limits<double>::infinity())
      seen.push_back({donor, distance});
  }
  count = std::min(count, seen.size());
  const auto closer = [](const Donor& a, const Donor& b) {
    return std::pair(a.weight, a.vertex) < std::pair(b.weight, b.vertex);
  };
  std::partial_sort(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(count), seen.end(),
                    closer);
  seen.resize(count);
  return seen;
}

std::vector<Donor> SurfaceInterpolation::weights(std::size_t vertex) const {
  std::vector<Donor> donors = nearest(vertex, kDonors);
  if (donors.size() < kFewest) return inverse_square_weights(std::move(donors));
  const auto [e1, e2] = tangent_frame(inward_[vertex]);
  const double unit_length = donors.back().weight;
  std::vector<Planar> points;
  for (const Donor& donor : donors) {
    const Vec3 offset = positions_[donor.vertex] - positions_[vertex];
    const Planar flat{dot(offset, e1), dot(offset, e2)};
    const double length = std::hypot(flat.x, flat.y);
    const double stretch = length > 0 ? donor.weight / (length * unit_length) : 0;
    points.push_back({flat.x * stretch, flat.y * stretch});
  }
  const std::vector<double> weights = spline_weights(points);
  if (!is_between(weights)) return inverse_square_weights(std::move(donors));
  for (std::size_t i = 0; i < donors.size(); ++i) donors[i].weight = weights[i];
  return donors;
}

}  // namespace palpate::fitting
