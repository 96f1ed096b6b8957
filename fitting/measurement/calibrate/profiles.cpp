// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "fitting/measurement/calibrate/descent.hpp"
#include "fitting/measurement/calibrate/least_squares.hpp"
#include "format/number_text.hpp"
#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

/// The problem with one constant fixed.
class FixedConstant {
 public:
  FixedConstant(const LeastSquares& problem, std::size_t fixed)
      : problem_(problem), fixed_(fixed), all_(problem.constants.size()) {
    reduced_ = problem;
    reduced_.constants.erase(reduced_.constants.begin() + static_cast<std::ptrdiff_t>(fixed));
    reduced_.model = [this](const double* c, double* r, double* J) { return evaluate(c, r, J); };
  }
  FixedConstant(const FixedConstant&) = delete;
  FixedConstant& operator=(const FixedConstant&) = delete;

  /// Cost of the best fit near `others`, which moves there; infinite where the model has no value.
  double cost(double value, std::vector<double>& others) {
    all_[fixed_] = value;
    for (std::size_t i = 0; i < others.size(); ++i) reduced_.constants[i].start = others[i];
    const auto found = descend(reduced_);
    if (!found) return std::numeric_limits<double>::infinity();
    others = found->at;
    return found->cost;
  }

 private:
  bool evaluate(const double* c, double* r, double* J) {
    const std::size_t n = all_.size();
    for (std::size_t i = 0, j = 0; i < n; ++i)
      if (i != fixed_) all_[i] = c[j++];
    std::vector<double> whole(J == nullptr ? 0 : problem_.residuals * n);
    if (!problem_.model(all_.data(), r, J == nullptr ? nullptr : whole.data())) return false;
    if (J == nullptr) return true;
    for (std::size_t row = 0; row < problem_.residuals; ++row)
      for (std::size_t i = 0, j = 0; i < n; ++i)
        if (i != fixed_) J[row * (n - 1) + j++] = whole[row * n + i];
    return true;
  }

  const LeastSquares& problem_;
  std::size_t fixed_;
  std::vector<double> all_;
  LeastSquares reduced_;
};

/// One end of a profile: from the best fit outwards until the cost has risen by `rise`. Followed is
/// the root of the rise, less its root at the end: -1 at the best fit, 0 at the end, and a straight
/// line between them where the model is linear.
class ProfileEnd {
 public:
  ProfileEnd(const LeastSquares& problem, const Calibration& best, std::size_t constant,
             double rise, double closeness)
      : constant_(problem.constants[constant]),
        fixed_(problem, constant),
        value_(best.estimates[constant].value),
        cost_(best.cost),
        rise_(rise),
        closeness_(closeness) {
    const Estimate& e = best.estimates[constant];
    for (std::size_t i = 0; i < best.estimates.size(); ++i) {
      if (i == constant) continue;
      const Estimate& other = best.estimates[i];
      const double c = best.correlation[i][constant];
      others_.push_back(other.value);
      bounds_.push_back(problem.constants[i]);
      slope_.push_back(std::isfinite(c) && e.standard_error > 0
                           ? c * other.standard_error / e.standard_error
                           : 0);
    }
    inside_ = value_;
  }

  /// `step`: where the end is expected, from the value. The bound, or infinity, when the profile
  /// has not got there at 4096 times the step.
  double find(double step) {
    constexpr double kFar = 4096;
    const double bound = step > 0 ? constant_.high : constant_.low;
    for (double reach = step; std::abs(reach) <= kFar * std::abs(step);) {
      const bool past = step > 0 ? value_ + reach >= bound : value_ + reach <= bound;
      const double outside = past ? bound : value_ + reach;
      const double excess = excess_at(outside);
      if (std::abs(excess) <= closeness_) return outside;
      if (excess > 0) return between(outside, excess);
      if (past) {
        stopped_ = true;
        return bound;
      }
      // A straight line would end there; a little more is likely to be outside.
      reach *= std::clamp(1.1 / (1 + excess), 1.1, 2.0);
    }
    return step > 0 ? kInfinity : -kInfinity;
  }

  /// Fits between the best one and the end.
  void fill(double end, int count) {
    for (int i = 1; i <= count && std::isfinite(end); ++i)
      excess_at(value_ + (end - value_) * i / (count + 1));
  }

  /// Values that were tried and their rise, over that at the end.
  const std::vector<std::pair<double, double>>& points() const { return points_; }
  bool met_better_fit() const { return better_; }
  /// Whether the constant fits as well up to its bound.
  bool stopped_at_bound() const { return stopped_; }
  bool ended_without_a_model() const { return no_model_; }

 private:
  /// Height of the best fit at this value; the state moves there while it is inside.
  double excess_at(double value) {
    constexpr double kSame = 0.01;  // of the rise: a fit that is better by less does not matter
    std::vector<double> others = predicted(value);
    const double cost = fixed_.cost(value, others);
    const double risen = cost - cost_;
    if (std::isfinite(risen)) points_.emplace_back(value, risen / rise_);
    better_ = better_ || risen < -kSame * rise_;
    const double excess = std::sqrt(std::max(0.0, risen) / rise_) - 1;
    if (excess > 0) return excess;
    const double moved = value - inside_;
    for (std::size_t i = 0; i < others_.size() && moved != 0; ++i)
      slope_[i] = (others[i] - others_[i]) / moved;
    others_ = others;
    inside_ = value;
    inside_excess_ = excess;
    return excess;
  }

  /// Where the other constants go, along the line through the last two fits.
  std::vector<double> predicted(double value) const {
    std::vector<double> out = others_;
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = std::clamp(out[i] + slope_[i] * (value - inside_), bounds_[i].low, bounds_[i].high);
    return out;
  }

  /// Regula falsi with halved weights [Dahlquist & Bjorck 1974, sec. 6.4].
  double between(double outside, double excess) {
    constexpr int kMost = 40;
    double inside_weight = inside_excess_, weight = excess;
    for (int i = 0; i < kMost; ++i) {
      no_model_ = !std::isfinite(weight);
      if (std::abs(outside - inside_) <= closeness_ * std::abs(outside - value_)) break;
      const double middle = no_model_
                                ? 0.5 * (inside_ + outside)
                                : outside - weight * (outside - inside_) / (weight - inside_weight);
      const double found = excess_at(middle);
      if (std::abs(found) <= closeness_) return middle;
      if (found > 0) {
        outside = middle;
        weight = found;
        inside_weight *= 0.5;
      } else {
        inside_weight = found;
        if (!no_model_) weight *= 0.5;
      }
    }
    return 0.5 * (inside_ + outside);
  }

  const Constant& constant_;
  FixedConstant fixed_;
  double value_, cost_, rise_, closeness_;
  std::vector<double> others_, slope_;  ///< of the last fit inside, and by the value
  std::vector<Constant> bounds_;        ///< of the others
  double inside_ = 0, inside_excess_ = -1;
  bool better_ = false, no_model_ = false, stopped_ = false;
  std::vector<std::pair<double, double>> points_;
};

std::string better_fit_text(const Estimate& e) {
  return "away from the best " + e.name + " there is a better fit: choose other starts";
}

/// What to say of the two ends of a constant.
void warn_of_profile(const Estimate& e, const ProfileEnd& below, const ProfileEnd& above,
                     std::vector<std::string>& warnings) {
  constexpr double kFar = 0.25;  // of the half width: how far an end is from the linearised one
  const double half = e.high - e.value;
  const auto text = [&](double value) {
    return number_text(e.logarithm ? std::exp(value) : value);
  };
  const std::string ends = text(e.profile_low) + " to " + text(e.profile_high);
  const double apart = std::max(std::abs(e.profile_low - e.low), std::abs(e.profile_high - e.high));
  if (below.met_better_fit() || above.met_better_fit()) {
    warnings.push_back(better_fit_text(e));
  } else if (!std::isfinite(e.profile_high - e.profile_low)) {
    warnings.push_back(e.name + " is not bounded by the data: its profile goes from " + ends);
  } else if (below.stopped_at_bound() || above.stopped_at_bound()) {
    warnings.push_back(e.name + " is not determined " +
                       (!above.stopped_at_bound()   ? "from below"
                        : !below.stopped_at_bound() ? "from above"
                                                    : "between its bounds") +
                       ": its profile, " + ends + ", ends at a bound");
  } else if (below.ended_without_a_model() || above.ended_without_a_model()) {
    warnings.push_back("the profile of " + e.name + ", " + ends +
                       ", ends where the model has no value: the data may allow more");
  } else if (apart > kFar * half) {
    warnings.push_back("the interval of " + e.name + " is not symmetric: its profile goes from " +
                       ends);
  }
}

/// The mean rise at which the intervals of the constants with one end; 0 where there is none.
double mean_rise(const Calibration& result) {
  double sum = 0;
  int count = 0;
  for (const Estimate& e : result.estimates) {
    const double width = (e.high - e.value) / e.unit_error;
    if (e.at_bound || !(width > 0) || !std::isfinite(width)) continue;
    sum += 0.5 * width * width;
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// The profile of a constant at a bound, to the other side.
void add_one_sided(const LeastSquares& problem, std::size_t constant, double closeness, int between,
                   Calibration& result) {
  constexpr double kFirstStep = 0.01;  // of the range
  const Constant& c = problem.constants[constant];
  const double rise = mean_rise(result), range = c.high - c.low;
  if (!(rise > 0) || !std::isfinite(range)) return;
  Estimate& e = result.estimates[constant];
  const bool up = e.value - c.low < c.high - e.value;
  ProfileEnd other(problem, result, constant, rise, closeness);
  const double end = other.find((up ? 1 : -1) * kFirstStep * range);
  other.fill(end, between);
  e.profile_low = up ? e.value : end;
  e.profile_high = up ? end : e.value;
  e.profile = other.points();
  e.profile.emplace_back(e.value, 0);
  std::sort(e.profile.begin(), e.profile.end());
  const auto text = [&](double value) {
    return number_text(e.logarithm ? std::exp(value) : value);
  };
  if (other.met_better_fit()) {
    result.warnings.push_back(better_fit_text(e));
  } else if (other.stopped_at_bound()) {
    result.warnings.push_back(e.name + " is not determined between its bounds " + text(c.low) +
                              " and " + text(c.high));
  } else {
    result.warnings.push_back(e.name + " is determined from " + (up ? "above" : "below") +
                              " alone: its profile goes from its bound to " + text(end));
  }
}

}  // namespace

void add_profiles(const LeastSquares& problem, Calibration& result,
                  const ProfileSettings& settings) {
  if (result.freedom <= 0) return;
  std::vector<std::size_t> of = settings.of;
  if (of.empty()) {
    for (std::size_t i = 0; i < result.estimates.size(); ++i) of.push_back(i);
  }
  for (const std::size_t i : of) {
    Estimate& e = result.estimates[i];
    const double half = e.high - e.value;
    if (e.at_bound && settings.at_bounds)
      add_one_sided(problem, i, settings.closeness, settings.between, result);
    if (e.at_bound || !(half > 0) || !std::isfinite(half)) continue;
    const double width = half / e.unit_error, rise = 0.5 * width * width;
    ProfileEnd below(problem, result, i, rise, settings.closeness);
    ProfileEnd above(problem, result, i, rise, settings.closeness);
    // The linearised interval of a constant that is not determined can have any size.
    const double step = e.value != 0 ? std::min(half, std::abs(e.value)) : half;
    e.profile_low = below.find(-step);
    e.profile_high = above.find(step);
    below.fill(e.profile_low, settings.between);
    above.fill(e.profile_high, settings.between);
    e.profile = below.points();
    e.profile.emplace_back(e.value, 0);
    e.profile.insert(e.profile.end(), above.points().begin(), above.points().end());
    std::sort(e.profile.begin(), e.profile.end());
    warn_of_profile(e, below, above, result.warnings);
  }
}

}  // namespace palpate::calibrate
