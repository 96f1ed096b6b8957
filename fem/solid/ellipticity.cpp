// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/ellipticity.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "fem/solid/element.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Number of starting directions; the form has few minima.
constexpr int kDirections = 48;
constexpr double kRoughTolerance = 1e-4, kFineTolerance = 1e-8;  ///< relative change of a step
constexpr int kRoughSteps = 10, kFineSteps = 100, kNewtonSteps = 20;
constexpr double kTurn = 1e-4;  ///< rad, step of difference quotients
constexpr int kCandidates = 8;  ///< number of rough minima that are refined
/// A pivot above this, over the largest entry of the diagonal, is positive beyond round-off.
constexpr double kPositive = 1e-8;

/// Spread evenly over a half sphere by the golden angle.
std::vector<Vector3d> half_sphere() {
  std::vector<Vector3d> directions;
  for (int i = 0; i < kDirections; ++i) {
    const double z = (i + 0.5) / kDirections, r = std::sqrt(1 - z * z);
    const double angle = std::numbers::pi * (3 - std::sqrt(5.0)) * i;
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

/// A_iJkL n_J n_L.
Matrix3d acoustic_tensor(const Tensor4<double>& A, const Vector3d& n) {
  Matrix3d Q = Matrix3d::Zero();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l)
          Q(i, k) += A[to_index(3 * i + j)][to_index(3 * k + l)] * n[j] * n[l];
  return Q;
}

/// A_iJkL m_i m_k.
Matrix3d transposed_tensor(const Tensor4<double>& A, const Vector3d& m) {
  Matrix3d Q = Matrix3d::Zero();
  for (int j = 0; j < 3; ++j)
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          Q(j, l) += A[to_index(3 * i + j)][to_index(3 * k + l)] * m[i] * m[k];
  return Q;
}

/// d cof F/dF for eight points.
Tensor4<Lanes> cofactor_tangent(const Tensor2<Lanes>& F) {
  Tensor4<Lanes> D;
  for (auto& row : D) row.fill(Lanes::Zero());
  add_cofactor_tangent(F, Lanes(Lanes::Ones()), D);
  return D;
}

/// The smallest pivot of an LDL^T decomposition: positive where A is positive definite. Pivots
/// after one that is not positive are void.
Lanes smallest_pivot(Tensor4<Lanes> A) {
  Lanes smallest = A[0][0];
  for (std::size_t p = 0; p < 9; ++p) {
    smallest = smallest.min(A[p][p]);
    const Lanes inverse = 1.0 / (A[p][p] > 0).select(A[p][p], Lanes::Ones());
    for (std::size_t i = p + 1; i < 9; ++i) {
      const Lanes factor = A[i][p] * inverse;
      for (std::size_t k = p + 1; k <= i; ++k) A[i][k] -= factor * A[k][p];
    }
  }
  return smallest;
}

Lanes inner(const Tensor4<Lanes>& A, const Tensor4<Lanes>& B) {
  Lanes sum = Lanes::Zero();
  for (std::size_t i = 0; i < 9; ++i) sum += double_contraction(A[i], B[i]);
  return sum;
}

/// The p of the best approximation of A by a 1 + b cof F x cof F - p dcof F/dF: at rest, where A is
/// of that form, the shear modulus.
Lanes neutral_pressure(const Tensor2<Lanes>& F, const Tensor4<Lanes>& A, const Tensor4<Lanes>& D) {
  const Tensor2<Lanes> cof = cofactor(F);
  Lanes A1 = Lanes::Zero(), Ac = Lanes::Zero(), Dc = Lanes::Zero();
  for (std::size_t i = 0; i < 9; ++i) {
    A1 += A[i][i];
    Ac += cof[i] * double_contraction(A[i], cof);
    Dc += cof[i] * double_contraction(D[i], cof);
  }
  // 1 and D are orthogonal. Normal equations, a eliminated first, then b.
  const Lanes c2 = double_contraction(cof, cof), cc = c2 * c2 * (1 - 1.0 / 9);
  const Lanes A_rest = Ac - c2 * A1 / 9;
  return (Dc * A_rest / cc - inner(A, D)) / (inner(D, D) - Dc * Dc / cc);
}

Tensor4<double> lane_of(const Tensor4<Lanes>& A, int lane) {
  Tensor4<double> one;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t k = 0; k < 9; ++k) one[i][k] = A[i][k][lane];
  return one;
}

struct Descent {
  double stiffness;
  Vector3d n;
};

/// The minimum reached from a direction, until the relative change of a step is below `tolerance`.
Descent descend(const Tensor4<double>& A, const Vector3d& start, double tolerance, int steps) {
  Eigen::SelfAdjointEigenSolver<Matrix3d> eigen;
  Descent now{std::numeric_limits<double>::infinity(), start};
  for (int step = 0; step < steps; ++step) {
    const double last = now.stiffness;
    eigen.compute(acoustic_tensor(A, now.n));
    eigen.compute(transposed_tensor(A, eigen.eigenvectors().col(0)));
    now = {eigen.eigenvalues()[0], eigen.eigenvectors().col(0)};
    if (step > 0 && !(now.stiffness < last - tolerance * std::abs(last))) break;
  }
  return now;
}

double weakest_along(const Tensor4<double>& A, const Vector3d& n) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(acoustic_tensor(A, n), Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

/// Newton's method over the sphere of directions, by difference quotients: alternating minimization
/// converges slowly along the valleys of stiff fibres. Only steps that lower the value are taken;
/// there may be none where two eigenvalues cross and the value has no derivative.
Descent sharpen(const Tensor4<double>& A, Descent now) {
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vector3d e1 = now.n.unitOrthogonal(), e2 = now.n.cross(e1);
    const auto turned = [&](double a, double b) {
      return (now.n + a * e1 + b * e2).normalized().eval();
    };
    const auto value = [&](double a, double b) {
      return weakest_along(A, turned(a * kTurn, b * kTurn));
    };
    const double f = value(0, 0), right = value(1, 0), left = value(-1, 0), up = value(0, 1),
                 down = value(0, -1);
    const double cross = (value(1, 1) - value(1, -1) - value(-1, 1) + value(-1, -1)) / 4;
    Eigen::Matrix2d hessian;
    hessian << right - 2 * f + left, cross, cross, up - 2 * f + down;
    const Eigen::Vector2d gradient((right - left) / 2, (up - down) / 2);
    if (!(hessian.determinant() > 0 && hessian(0, 0) > 0)) break;
    const Eigen::Vector2d turn = -kTurn * hessian.inverse() * gradient;
    if (!(turn.norm() < 1)) break;
    const Vector3d n = turned(turn[0], turn[1]);
    const double stiffness = weakest_along(A, n);
    if (!(stiffness < now.stiffness)) break;
    now = {stiffness, n};
  }
  return now;
}

}  // namespace

double min_acoustic_eigenvalue(const Tensor4<double>& A) {
  static const std::vector<Vector3d> directions = half_sphere();
  std::vector<Descent> found;
  for (const Vector3d& start : directions)
    found.push_back(descend(A, start, kRoughTolerance, kRoughSteps));
  std::sort(found.begin(), found.end(),
            [](const Descent& a, const Descent& b) { return a.stiffness < b.stiffness; });
  // Two minima may be nearer to each other than the rough values are to them.
  double weakest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kCandidates; ++i)
    weakest = std::min(
        weakest,
        sharpen(A, descend(A, found[to_index(i)].n, kFineTolerance, kFineSteps)).stiffness);
  return weakest;
}

Lanes min_acoustic_eigenvalue(const Tensor2<Lanes>& F, const Tensor4<Lanes>& A) {
  const Tensor4<Lanes> D = cofactor_tangent(F);
  const Lanes p = neutral_pressure(F, A, D);
  Tensor4<Lanes> shifted = A;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t k = 0; k < 9; ++k) shifted[i][k] += p * D[i][k];
  Lanes size = Lanes::Zero();
  for (std::size_t i = 0; i < 9; ++i) size = size.max(A[i][i].abs());
  Lanes weakest = smallest_pivot(shifted);
  for (int lane = 0; lane < kLanes; ++lane)
    if (!(weakest[lane] > kPositive * size[lane]))
      weakest[lane] = min_acoustic_eigenvalue(lane_of(A, lane));
  return weakest;
}

}  // namespace palpate::fem
