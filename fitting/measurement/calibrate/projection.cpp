// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/projection.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace palpate::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

MatrixXd columns_of(const RowMajor& J, const std::vector<std::size_t>& which) {
  MatrixXd out(J.rows(), static_cast<Index>(which.size()));
  for (std::size_t k = 0; k < which.size(); ++k)
    out.col(static_cast<Index>(k)) = J.col(static_cast<Index>(which[k]));
  return out;
}

/// Columns of unit length, and by what they were divided; constants of other sizes count alike.
VectorXd normalise(MatrixXd& A) {
  VectorXd lengths = A.colwise().norm();
  for (Index k = 0; k < A.cols(); ++k) {
    if (!(lengths[k] > 0)) lengths[k] = 1;
    A.col(k) /= lengths[k];
  }
  return lengths;
}

}  // namespace

/// The whole problem where its linear constants are best.
struct Projection::Best {
  std::vector<double> at;         ///< all constants
  std::vector<std::size_t> free;  ///< the linear ones that are at no bound
  VectorXd residuals;
  RowMajor J;
};

Projection::Projection(const LeastSquares& problem) : problem_(problem) {
  for (std::size_t k = 0; k < problem.constants.size(); ++k)
    (problem.constants[k].linear ? linear_ : bent_).push_back(k);
}

/// The linear constants move to the least squares; of those that would leave their bounds the one
/// that goes farthest, in what it contributes to the residuals, stays at it, and so on.
bool Projection::solve(const double* bent, Best& best) const {
  const std::vector<Constant>& constants = problem_.constants;
  best.at.resize(constants.size());
  for (std::size_t k = 0; k < bent_.size(); ++k) best.at[bent_[k]] = bent[k];
  for (const std::size_t k : linear_) best.at[k] = constants[k].start;
  best.residuals.resize(static_cast<Index>(problem_.residuals));
  best.J.resize(best.residuals.size(), static_cast<Index>(constants.size()));
  const auto evaluate = [&] {
    return problem_.model(best.at.data(), best.residuals.data(), best.J.data());
  };
  best.free = linear_;
  while (evaluate() && !best.free.empty()) {
    MatrixXd A = columns_of(best.J, best.free);
    const VectorXd lengths = normalise(A);
    const VectorXd step = A.completeOrthogonalDecomposition().solve(-best.residuals);
    std::size_t worst = best.free.size();
    double farthest = 0, bound = 0;
    for (std::size_t k = 0; k < best.free.size(); ++k) {
      const Constant& c = constants[best.free[k]];
      const double length = lengths[static_cast<Index>(k)];
      const double value = best.at[best.free[k]] + step[static_cast<Index>(k)] / length;
      const double inside = std::clamp(value, c.low, c.high);
      const double beyond = std::abs(value - inside) * length;
      if (!(beyond > farthest)) continue;
      worst = k, farthest = beyond, bound = inside;
    }
    if (worst < best.free.size()) {
      best.at[best.free[worst]] = bound;
      best.free.erase(best.free.begin() + static_cast<std::ptrdiff_t>(worst));
      continue;
    }
    for (std::size_t k = 0; k < best.free.size(); ++k)
      best.at[best.free[k]] += step[static_cast<Index>(k)] / lengths[static_cast<Index>(k)];
    return evaluate();
  }
  return evaluate();
}

LeastSquares Projection::reduced() const {
  LeastSquares reduced;
  for (const std::size_t k : bent_) reduced.constants.push_back(problem_.constants[k]);
  reduced.residuals = problem_.residuals;
  reduced.max_iterations = problem_.max_iterations;
  reduced.tolerance = problem_.tolerance;
  reduced.step_tolerance = problem_.step_tolerance;
  reduced.offset_tolerance = problem_.offset_tolerance;
  reduced.known_scatter = problem_.known_scatter;
  reduced.model = [this](const double* bent, double* r, double* J) {
    Best best;
    if (!solve(bent, best)) return false;
    std::copy(best.residuals.begin(), best.residuals.end(), r);
    if (J == nullptr) return true;
    MatrixXd slopes = columns_of(best.J, bent_);
    if (!best.free.empty()) {
      MatrixXd A = columns_of(best.J, best.free);
      normalise(A);
      const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
      const MatrixXd Q = qr.householderQ() * MatrixXd::Identity(A.rows(), qr.rank());
      slopes -= Q * (Q.transpose() * slopes);
    }
    Eigen::Map<RowMajor>(J, slopes.rows(), slopes.cols()) = slopes;
    return true;
  };
  return reduced;
}

bool Projection::expand(const double* bent, std::vector<double>& all) const {
  Best best;
  if (!solve(bent, best)) return false;
  all = best.at;
  return true;
}

}  // namespace palpate::calibrate
