// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/nnls.hpp"

#include <Eigen/QR>
#include <limits>
#include <vector>

#include "format/error.hpp"

namespace palpate::fitting {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Unconstrained minimum over the free columns; the others are zero.
VectorXd solve_free(const MatrixXd& A, const VectorXd& b, const std::vector<char>& free) {
  std::vector<Index> columns;
  for (Index j = 0; j < A.cols(); ++j) {
    if (free[static_cast<std::size_t>(j)]) columns.push_back(j);
  }
  VectorXd x = VectorXd::Zero(A.cols());
  if (columns.empty()) return x;
  const VectorXd part = MatrixXd(A(Eigen::all, columns)).colPivHouseholderQr().solve(b);
  for (std::size_t i = 0; i < columns.size(); ++i) x[columns[i]] = part[static_cast<Index>(i)];
  return x;
}

/// The bound variable whose release lowers the residual fastest; -1 when none does.
Index steepest(const VectorXd& w, const std::vector<char>& free, const std::vector<char>& barred,
               double tolerance) {
  Index best = -1;
  for (Index j = 0; j < w.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (!free[i] && !barred[i] && w[j] > tolerance && (best < 0 || w[j] > w[best])) best = j;
  }
  return best;
}

/// Longest step from x towards z that stays non-negative; the variables it stops at are bound.
void step_to_bound(VectorXd& x, const VectorXd& z, std::vector<char>& free) {
  double alpha = 1;
  Index blocking = -1;
  for (Index j = 0; j < x.size(); ++j) {
    if (!free[static_cast<std::size_t>(j)] || z[j] > 0) continue;
    const double reach = x[j] / (x[j] - z[j]);
    if (blocking < 0 || reach < alpha) {
      alpha = reach;
      blocking = j;
    }
  }
  x += alpha * (z - x);
  for (Index j = 0; j < x.size(); ++j) {
    if (j != blocking && x[j] > 0) continue;
    if (z[j] > 0) continue;
    x[j] = 0;
    free[static_cast<std::size_t>(j)] = 0;
  }
}

bool all_positive(const VectorXd& z, const std::vector<char>& free) {
  for (Index j = 0; j < z.size(); ++j) {
    if (free[static_cast<std::size_t>(j)] && z[j] <= 0) return false;
  }
  return true;
}

}  // namespace

VectorXd nonnegative_least_squares(const MatrixXd& matrix, const VectorXd& b) {
  const Index n = matrix.cols();
  // Columns of unit length make one tolerance mean the same for every unknown.
  VectorXd scale = matrix.colwise().norm();
  for (Index j = 0; j < n; ++j) scale[j] = scale[j] > 0 ? 1 / scale[j] : 0;
  const MatrixXd A = matrix * scale.asDiagonal();
  const double tolerance = 64 * std::numeric_limits<double>::epsilon() * (b.norm() + 1e-300);

  VectorXd x = VectorXd::Zero(n);
  std::vector<char> free(static_cast<std::size_t>(n), 0);
  std::vector<char> barred(static_cast<std::size_t>(n), 0);
  for (Index turn = 0; turn < 30 * n + 30; ++turn) {
    const VectorXd w = A.transpose() * (b - A * x);
    const Index entering = steepest(w, free, barred, tolerance);
    if (entering < 0) return scale.asDiagonal() * x;
    free[static_cast<std::size_t>(entering)] = 1;
    VectorXd z = solve_free(A, b, free);
    if (z[entering] <= 0) {  // rounding only: w said that it would grow
      free[static_cast<std::size_t>(entering)] = 0;
      barred[static_cast<std::size_t>(entering)] = 1;
      continue;
    }
    while (!all_positive(z, free)) {
      step_to_bound(x, z, free);
      z = solve_free(A, b, free);
    }
    x = z;
    barred.assign(barred.size(), 0);
  }
  throw Error(ErrorKind::Internal, "non-negative least squares",
              "the active set did not settle for " + std::to_string(n) + " unknowns",
              "report the curve that was being fitted");
}

}  // namespace palpate::fitting
