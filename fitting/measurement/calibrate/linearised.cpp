// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/linearised.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Vector = Linearised::Vector;

/// min |A q - y|^2 within bounds that hold 0. The constants of `free_` move, the others are at
/// bounds.
class ActiveSet {
 public:
  ActiveSet(const MatrixXd& A, const Vector& y, const Vector& low, const Vector& high)
      : A_(A), y_(y), low_(low), high_(high), q_(Vector::Zero(A.cols())) {
    const Vector slope = gradient();
    for (Index i = 0; i < A.cols(); ++i) free_.push_back(!is_pushed_out(i, slope[i]));
  }

  Vector solve() {
    // Each round frees one constant; more rounds are the work of rounding.
    const Index most = 3 * A_.cols() + 3;
    for (Index round = 0; round < most; ++round) {
      while (move_free()) {
      }
      if (!release()) break;
    }
    return q_;
  }

 private:
  Vector gradient() const { return A_.transpose() * (A_ * q_ - y_); }

  bool is_pushed_out(Index i, double slope) const {
    return (q_[i] <= low_[i] && slope > 0) || (q_[i] >= high_[i] && slope < 0);
  }

  std::vector<Index> free_ones() const {
    std::vector<Index> which;
    for (Index i = 0; i < q_.size(); ++i)
      if (free_[static_cast<std::size_t>(i)]) which.push_back(i);
    return which;
  }

  /// The free constants towards their best, as far as the first bound. True where it stopped there.
  bool move_free() {
    const std::vector<Index> which = free_ones();
    if (which.empty()) return false;
    const MatrixXd own = A_(Eigen::all, which);
    const Vector change = own.colPivHouseholderQr().solve(y_ - A_ * q_);
    double part = 1;
    Index stopped = -1;
    for (std::size_t k = 0; k < which.size(); ++k) {
      const Index i = which[k];
      const double d = change[static_cast<Index>(k)], room = (d > 0 ? high_[i] : low_[i]) - q_[i];
      if (d == 0 || !(room / d < part)) continue;
      part = room / d;
      stopped = i;
    }
    for (std::size_t k = 0; k < which.size(); ++k)
      q_[which[k]] += part * change[static_cast<Index>(k)];
    if (stopped < 0) return false;
    const bool up = high_[stopped] - q_[stopped] < q_[stopped] - low_[stopped];
    q_[stopped] = up ? high_[stopped] : low_[stopped];
    free_[static_cast<std::size_t>(stopped)] = false;
    return true;
  }

  /// Frees the constant at a bound that would lower the cost most by leaving it.
  bool release() {
    constexpr double kRounding = 1e-12;
    const Vector slope = gradient();
    double steepest = kRounding * y_.norm();
    Index best = -1;
    for (Index i = 0; i < q_.size(); ++i) {
      if (free_[static_cast<std::size_t>(i)] || is_pushed_out(i, slope[i])) continue;
      if (!(std::abs(slope[i]) > steepest)) continue;
      steepest = std::abs(slope[i]);
      best = i;
    }
    if (best < 0) return false;
    free_[static_cast<std::size_t>(best)] = true;
    return true;
  }

  const MatrixXd& A_;
  const Vector &y_, &low_, &high_;
  Vector q_;
  std::vector<bool> free_;
};

}  // namespace

Linearised::Linearised(const RowMajor& J, const Vector& r) : scale_(J.colwise().norm()) {
  for (Index i = 0; i < scale_.size(); ++i)
    if (!(scale_[i] > 0)) scale_[i] = 1;
  const Index rows = std::min(J.rows(), J.cols());
  const Eigen::HouseholderQR<MatrixXd> qr(J * scale_.cwiseInverse().asDiagonal());
  R_ = MatrixXd(qr.matrixQR().topRows(rows)).triangularView<Eigen::Upper>();
  c_ = Vector(qr.householderQ().transpose() * r).head(rows);
}

Linearised::Vector Linearised::step(double damping, const Vector& low, const Vector& high) const {
  const Index n = scale_.size();
  MatrixXd A(R_.rows() + n, n);
  A << R_, std::sqrt(damping) * MatrixXd::Identity(n, n);
  Vector y = Vector::Zero(A.rows());
  y.head(c_.size()) = -c_;
  const Vector scaled_low = scale_.cwiseProduct(low), scaled_high = scale_.cwiseProduct(high);
  const Vector q = ActiveSet(A, y, scaled_low, scaled_high).solve();
  Vector p(n);
  // At a bound exactly, not but for the rounding of the scale.
  for (Index i = 0; i < n; ++i)
    p[i] = q[i] <= scaled_low[i]    ? low[i]
           : q[i] >= scaled_high[i] ? high[i]
                                    : std::clamp(q[i] / scale_[i], low[i], high[i]);
  return p;
}

double Linearised::decrease(const Vector& p) const {
  const Vector change = R_ * scale_.cwiseProduct(p);
  return -change.dot(c_) - 0.5 * change.squaredNorm();
}

}  // namespace palpate::calibrate
