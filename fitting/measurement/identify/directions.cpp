// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/directions.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace palpate::identify {
namespace {

constexpr double kLeastDeviation = 1e-6;  // of the largest value: no weight is infinite

std::vector<std::size_t> axes_of(const std::vector<Directional>& measured) {
  std::vector<std::size_t> axes;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::any_of(measured.begin(), measured.end(),
                    [axis](const Directional& d) { return d.direction[axis] != 0; }))
      axes.push_back(axis);
  return axes;
}

/// Deviations with a floor, so that exact values have a finite weight.
Eigen::VectorXd deviations_of(const std::vector<Directional>& measured) {
  double largest = 0;
  for (const Directional& d : measured) largest = std::max(largest, std::abs(d.value.value));
  Eigen::VectorXd deviations(static_cast<Eigen::Index>(measured.size()));
  for (Eigen::Index i = 0; i < deviations.size(); ++i)
    deviations[i] =
        std::max(measured[static_cast<std::size_t>(i)].value.deviation, kLeastDeviation * largest);
  return deviations;
}

struct Fit {
  Eigen::VectorXd solution;
  Eigen::MatrixXd covariance;
  double squares = kInfinity;  ///< of the residuals in deviations
};

Fit weighted_fit(Eigen::MatrixXd rows, Eigen::VectorXd values, const Eigen::VectorXd& deviations) {
  rows = deviations.cwiseInverse().asDiagonal() * rows;
  values = values.cwiseQuotient(deviations);
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(rows);
  Fit fit;
  fit.solution = decomposition.solve(values);
  const Eigen::MatrixXd inverse = decomposition.pseudoInverse();
  fit.covariance = inverse * inverse.transpose();
  fit.squares = (values - rows * fit.solution).squaredNorm();
  const auto spare = static_cast<double>(rows.rows() - decomposition.rank());
  if (spare > 0) fit.covariance *= std::max(1.0, fit.squares / spare);
  return fit;
}

Eigen::VectorXd values_of(const std::vector<Directional>& measured) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(measured.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = measured[static_cast<std::size_t>(i)].value.value;
  return values;
}

/// Rows: the directions by the axes of their span.
Eigen::MatrixXd components(const std::vector<Directional>& measured,
                           const std::vector<std::size_t>& axes) {
  Eigen::MatrixXd n(static_cast<Eigen::Index>(measured.size()),
                    static_cast<Eigen::Index>(axes.size()));
  for (Eigen::Index i = 0; i < n.rows(); ++i)
    for (Eigen::Index j = 0; j < n.cols(); ++j)
      n(i, j) = measured[static_cast<std::size_t>(i)].direction[axes[static_cast<std::size_t>(j)]];
  return n;
}

}  // namespace

std::vector<Vec3> directions_between(const std::vector<std::size_t>& axes) {
  std::vector<Vec3> directions;
  const auto has = [&axes](std::size_t axis) {
    return std::find(axes.begin(), axes.end(), axis) != axes.end();
  };
  for (int parts = 1; parts <= 3; ++parts)
    for (int code = 0; code < 27; ++code) {
      const std::array<int, 3> signs{code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1};
      const auto first = std::find_if(signs.begin(), signs.end(), [](int s) { return s != 0; });
      const auto count = 3 - std::count(signs.begin(), signs.end(), 0);
      if (count != parts || *first < 0) continue;
      Vec3 direction{};
      bool within = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        within = within && (signs[axis] == 0 || has(axis));
        direction[axis] = signs[axis] / std::sqrt(parts);
      }
      if (within) directions.push_back(direction);
    }
  return directions;
}

std::string direction_name(const Vec3& direction) {
  std::string name;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    if (direction[axis] < 0)
      name += "-";
    else if (!name.empty())
      name += "+";
    name += static_cast<char>('x' + axis);
  }
  return name;
}

Frame frame_along(const Vec3& direction) noexcept {
  std::size_t least = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (std::abs(direction[axis]) <= std::abs(direction[least])) least = axis;
  Vec3 up{};
  up[least] = 1;
  const Vec3 across = cross(up, direction);
  const Vec3 second = (1 / norm(across)) * across;
  return {direction, second, cross(direction, second)};
}

Vec3 in_frame(const Frame& frame, const Vec3& vector) noexcept {
  return {dot(frame[0], vector), dot(frame[1], vector), dot(frame[2], vector)};
}

Measured smallest_damping(const std::vector<Directional>& damping) {
  const std::vector<std::size_t> axes = axes_of(damping);
  const Eigen::MatrixXd n = components(damping, axes);
  Eigen::MatrixXd rows(n.rows(), n.cols() * (n.cols() + 1) / 2);
  for (Eigen::Index i = 0, column = 0; i < n.cols(); ++i)
    for (Eigen::Index j = i; j < n.cols(); ++j, ++column)
      rows.col(column) = (i == j ? 1 : 2) * n.col(i).cwiseProduct(n.col(j));
  const Fit fit = weighted_fit(rows, values_of(damping), deviations_of(damping));
  Eigen::MatrixXd b(n.cols(), n.cols());
  double squares = 0;
  for (Eigen::Index i = 0, column = 0; i < n.cols(); ++i)
    for (Eigen::Index j = i; j < n.cols(); ++j, ++column) {
      b(i, j) = b(j, i) = fit.solution[column];
      squares += (i == j ? 1 : 2) * fit.covariance(column, column);
    }
  return {Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(b).eigenvalues()[0], std::sqrt(squares)};
}

Measured smallest_friction(const std::vector<Directional>& friction) {
  return std::min_element(friction.begin(), friction.end(),
                          [](const Directional& a, const Directional& b) {
                            return a.value.low() < b.value.low();
                          })
      ->value;
}

}  // namespace palpate::identify
