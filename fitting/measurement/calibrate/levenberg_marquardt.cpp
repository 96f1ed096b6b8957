// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/levenberg_marquardt.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/measurement/calibrate/linearised.hpp"

namespace palpate::calibrate {
namespace {

using Eigen::Index;
using RowMajor = Linearised::RowMajor;
using Vector = Linearised::Vector;

/// Damping, over the columns of unit length: of the first step, of one that is as good as none, and
/// the range beyond which it makes no difference.
constexpr double kFirstDamping = 1e-4, kUndamped = 1e-14, kMostDamping = 1e16;
/// Gains at which a step is taken, and at which the next one is damped less.
constexpr double kLeastGain = 1e-3, kGoodGain = 0.75;
/// What the damping is multiplied by after a step of good gain, after one that is not taken, and
/// after one to where the model has no value.
constexpr double kAfterGood = 0.1, kAfterNone = 6, kAfterNoValue = 30;
/// Steps in succession to where the model has no value, at most.
constexpr int kMostWithoutValue = 8;

class Search {
 public:
  explicit Search(const LeastSquares& problem)
      : problem_(problem), x_(static_cast<Index>(problem.constants.size())) {
    for (Index i = 0; i < x_.size(); ++i) x_[i] = constant(i).start;
  }

  bool start() {
    if (!value_at(x_, r_)) return false;
    cost_ = 0.5 * r_.squaredNorm();
    return x_.size() == 0 || slopes();
  }

  void run() {
    while (!converged_ && iterations_ < problem_.max_iterations && go_on()) {
    }
  }

  Minimum minimum() const {
    Minimum found;
    found.at.assign(x_.data(), x_.data() + x_.size());
    found.residuals.assign(r_.data(), r_.data() + r_.size());
    found.J.assign(J_.data(), J_.data() + J_.size());
    found.cost = cost_;
    found.converged = converged_;
    found.iterations = iterations_;
    return found;
  }

 private:
  const Constant& constant(Index i) const {
    return problem_.constants[static_cast<std::size_t>(i)];
  }

  bool value_at(const Vector& x, Vector& r) const {
    r.resize(static_cast<Index>(problem_.residuals));
    return problem_.model(x.data(), r.data(), nullptr) && r.allFinite();
  }

  bool slopes() {
    J_.resize(r_.size(), x_.size());
    return problem_.model(x_.data(), r_.data(), J_.data()) && J_.allFinite();
  }

  /// One step that is taken, or the end.
  bool go_on() {
    const Linearised linear(J_, r_);
    Vector low = x_, high = x_;
    for (Index i = 0; i < x_.size(); ++i) {
      low[i] = constant(i).low - x_[i];
      high[i] = constant(i).high - x_[i];
    }
    converged_ = is_close(linear.decrease(linear.step(kUndamped, low, high)));
    while (!converged_ && iterations_ < problem_.max_iterations) {
      ++iterations_;
      const Vector p = linear.step(damping_, low, high);
      const double promised = linear.decrease(p);
      const double tolerance = problem_.step_tolerance;
      converged_ =
          !(promised > 0) || linear.length(p) <= tolerance * (linear.length(x_) + tolerance);
      if (converged_) break;
      switch (attempt(moved(p, low, high), promised)) {
        case Outcome::Taken:
          return true;
        case Outcome::NotTaken:
          break;
        case Outcome::NoValue:
          if (++without_value_ > kMostWithoutValue) return false;
      }
    }
    return false;
  }

  enum class Outcome { Taken, NotTaken, NoValue };

  Outcome attempt(const Vector& x, double promised) {
    Vector r;
    if (!value_at(x, r)) {
      damp(kAfterNoValue);
      return Outcome::NoValue;
    }
    without_value_ = 0;
    const double cost = 0.5 * r.squaredNorm(), gain = (cost_ - cost) / promised;
    if (!(gain > kLeastGain)) {
      damp(kAfterNone);
      return Outcome::NotTaken;
    }
    if (gain > kGoodGain) damp(kAfterGood);
    converged_ = cost_ - cost <= problem_.tolerance * cost_;
    x_ = x;
    r_ = std::move(r);
    cost_ = cost;
    return slopes() ? Outcome::Taken : Outcome::NoValue;
  }

  void damp(double factor) { damping_ = std::clamp(damping_ * factor, kUndamped, kMostDamping); }

  /// Exactly at a bound where the step ends there.
  Vector moved(const Vector& p, const Vector& low, const Vector& high) const {
    Vector x = x_ + p;
    for (Index i = 0; i < x.size(); ++i) {
      const Constant& c = constant(i);
      x[i] = p[i] <= low[i] ? c.low : p[i] >= high[i] ? c.high : std::clamp(x[i], c.low, c.high);
    }
    return x;
  }

  /// Whether the cost cannot fall by more than a little of what noise does to it [Bates & Watts
  /// 1981]: a cost that is higher by s^2/2 is one standard error away.
  bool is_close(double to_gain) const {
    if (!(problem_.offset_tolerance > 0)) return false;
    const Index freedom = r_.size() - x_.size();
    const double of_residuals = freedom > 0 ? 2 * cost_ / static_cast<double>(freedom) : 0;
    const double variance = problem_.known_scatter ? std::max(1.0, of_residuals) : of_residuals;
    return to_gain <= 0.5 * problem_.offset_tolerance * problem_.offset_tolerance * variance;
  }

  const LeastSquares& problem_;
  Vector x_, r_;
  RowMajor J_;
  double cost_ = 0, damping_ = kFirstDamping;
  int iterations_ = 0, without_value_ = 0;
  bool converged_ = false;
};

}  // namespace

std::optional<Minimum> levenberg_marquardt(const LeastSquares& problem) {
  Search search(problem);
  if (!search.start()) return std::nullopt;
  search.run();
  return search.minimum();
}

}  // namespace palpate::calibrate
