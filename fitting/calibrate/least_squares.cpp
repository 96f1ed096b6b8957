// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/calibrate/least_squares.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "fitting/measured/statistics.hpp"
#include "format/error.hpp"

namespace palpate::calibrate {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kStrongCorrelation = 0.95;
/// Costs closer than this, relatively, are the same.
constexpr double kSameCost = 1e-6;
/// Distance to a bound, relative to its size, that counts as being there.
constexpr double kAtBound = 1e-8;

[[noreturn]] void refuse(const std::string& where, const std::string& problem,
                         const std::string& remedy) {
  throw Error(ErrorKind::Configuration, where, problem, remedy);
}

class Cost : public ceres::CostFunction {
 public:
  explicit Cost(const LeastSquares& problem) : problem_(problem) {
    set_num_residuals(static_cast<int>(problem.residuals));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.constants.size()));
  }
  bool Evaluate(const double* const* constants, double* r, double** J) const override {
    return problem_.model(constants[0], r, J != nullptr ? J[0] : nullptr);
  }

 private:
  const LeastSquares& problem_;
};

/// Dense symmetric matrices of a few rows.
using Matrix = std::vector<std::vector<double>>;

/// Eigenvalues and vectors (columns) by Jacobi rotations [Golub & Van Loan 1996, sec. 8.4].
void eigen_system(Matrix a, std::vector<double>& values, Matrix& vectors) {
  const std::size_t n = a.size();
  vectors.assign(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) vectors[i][i] = 1;
  for (int sweep = 0; sweep < 60; ++sweep) {
    double off = 0;
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        off = std::max(off, std::abs(a[p][q]));
        if (a[p][q] == 0) continue;
        const double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1 / std::hypot(t, 1.0), s = t * c;
        for (std::size_t k = 0; k < n; ++k) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < n; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
          const double vp = vectors[k][p], vq = vectors[k][q];
          vectors[k][p] = c * vp - s * vq;
          vectors[k][q] = s * vp + c * vq;
        }
      }
    }
    if (off < 1e-16) break;
  }
  values.resize(n);
  for (std::size_t i = 0; i < n; ++i) values[i] = a[i][i];
}

bool is_at(double value, double bound) {
  return std::isfinite(bound) &&
         std::abs(value - bound) <= kAtBound * std::max(1e-12, std::abs(bound));
}

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Whether residuals over their stated uncertainty scatter more than chance lets them: a scatter of
/// one over n - p residuals is itself uncertain by 1/sqrt(2 (n - p)).
bool is_unexplained(const Calibration& result) {
  constexpr double kDeviations = 3;
  return result.freedom > 0 && result.scatter > 1 + kDeviations / std::sqrt(2.0 * result.freedom);
}

/// Covariance of the free constants from the Jacobian, scaled to a unit diagonal for the condition.
void add_intervals(const LeastSquares& problem, const std::vector<double>& J,
                   const std::vector<double>& r, Calibration& result) {
  const std::size_t columns = problem.constants.size();
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < columns; ++i) {
    if (!result.estimates[i].at_bound) free.push_back(i);
  }
  const std::size_t n = free.size();
  result.freedom = static_cast<int>(problem.residuals) - static_cast<int>(n);
  double squares = 0;
  for (const double value : r) squares += value * value;
  result.scatter = std::sqrt(squares / std::max(1, result.freedom));
  Matrix normal(n, std::vector<double>(n, 0.0));
  for (std::size_t row = 0; row < problem.residuals; ++row) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        normal[i][j] += J[row * columns + free[i]] * J[row * columns + free[j]];
      }
    }
  }
  std::vector<double> scale(n);
  for (std::size_t i = 0; i < n; ++i) scale[i] = std::sqrt(normal[i][i]);
  Matrix unit = normal, vectors;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      unit[i][j] = scale[i] > 0 && scale[j] > 0 ? normal[i][j] / (scale[i] * scale[j]) : 0;
    }
  }
  std::vector<double> values;
  eigen_system(unit, values, vectors);
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  result.condition = n == 0       ? 1
                     : *least > 0 ? std::sqrt(*largest / *least)
                                  : std::numeric_limits<double>::infinity();
  Matrix covariance(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        const double value = std::max(values[k], 1e-16 * *largest);
        covariance[i][j] += vectors[i][k] * vectors[j][k] / (value * scale[i] * scale[j]);
      }
    }
  }
  result.widened = problem.known_scatter && is_unexplained(result);
  const bool estimated = !problem.known_scatter || result.widened;
  const double s = estimated ? result.scatter : 1;
  const double t = result.freedom > 0 ? measured::student_quantile(problem.confidence,
                                                                   estimated ? result.freedom : 1e6)
                                      : std::numeric_limits<double>::infinity();
  result.correlation.assign(columns, std::vector<double>(columns, kUnknown));
  for (std::size_t i = 0; i < n; ++i) {
    Estimate& e = result.estimates[free[i]];
    e.standard_error = s * std::sqrt(covariance[i][i]);
    e.low = e.value - t * e.standard_error;
    e.high = e.value + t * e.standard_error;
    for (std::size_t j = 0; j < n; ++j) {
      result.correlation[free[i]][free[j]] =
          covariance[i][j] / std::sqrt(covariance[i][i] * covariance[j][j]);
    }
  }
}

void add_warnings(Calibration& result) {
  const auto warn = [&](const std::string& text) { result.warnings.push_back(text); };
  for (std::size_t i = 0; i < result.estimates.size(); ++i) {
    const Estimate& e = result.estimates[i];
    if (e.at_bound) {
      warn(e.name + " is at its bound " + text_of(e.value) +
           ": the interval says nothing there; widen the bound or choose another law");
      continue;
    }
    if (!(0.5 * (e.high - e.low) < std::abs(e.value))) {
      warn(e.name + " is not determined: its interval is wider than its value");
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double c = result.correlation[i][j];
      if (!(std::abs(c) > kStrongCorrelation)) continue;
      warn(result.estimates[j].name + " and " + e.name + " are correlated by " + text_of(c) +
           ": the data hardly tell them apart");
    }
  }
  if (result.widened) {
    warn("the residuals are " + text_of(result.scatter) +
         " times the stated uncertainty: the model does not describe the data within it; the "
         "intervals are widened by that factor, as if the misfit were noise");
  }
  if (!result.converged) warn("the iteration did not converge");
}

void check_problem(const LeastSquares& problem, const std::string& where) {
  if (problem.residuals < problem.constants.size()) {
    refuse(where,
           std::to_string(problem.residuals) + " values cannot determine " +
               std::to_string(problem.constants.size()) + " constants",
           "give more data or a law with fewer constants");
  }
  for (const Constant& c : problem.constants) {
    if (c.start >= c.low && c.start <= c.high) continue;
    refuse(where,
           "the start " + text_of(c.start) + " of " + c.name + " is not within " + text_of(c.low) +
               " .. " + text_of(c.high),
           "choose a start within the bounds");
  }
}

/// Where a descent ended.
struct Minimum {
  std::vector<double> at, residuals;
  double cost = 0;
  bool converged = false;
  int iterations = 0;
};

std::optional<Minimum> descend(const LeastSquares& problem) {
  const std::size_t n = problem.constants.size();
  Minimum found;
  found.at.resize(n);
  found.residuals.resize(problem.residuals);
  for (std::size_t i = 0; i < n; ++i) found.at[i] = problem.constants[i].start;
  double* p = found.at.data();
  if (!problem.model(p, found.residuals.data(), nullptr)) return std::nullopt;
  if (n > 0) {
    ceres::Problem solver;
    solver.AddResidualBlock(new Cost(problem), nullptr, p);
    for (std::size_t i = 0; i < n; ++i) {
      const Constant& c = problem.constants[i];
      if (std::isfinite(c.low)) solver.SetParameterLowerBound(p, static_cast<int>(i), c.low);
      if (std::isfinite(c.high)) solver.SetParameterUpperBound(p, static_cast<int>(i), c.high);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = problem.max_iterations;
    options.function_tolerance = problem.tolerance;
    options.parameter_tolerance = problem.step_tolerance;
    options.gradient_tolerance = 1e-14;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &solver, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    if (!problem.model(p, found.residuals.data(), nullptr)) return std::nullopt;
    found.converged = summary.termination_type == ceres::CONVERGENCE;
    found.iterations = static_cast<int>(summary.iterations.size()) - 1;
  }
  for (const double value : found.residuals) found.cost += 0.5 * value * value;
  return found;
}

std::optional<Calibration> try_minimise(const LeastSquares& problem) {
  const std::size_t n = problem.constants.size();
  const auto found = descend(problem);
  if (!found) return std::nullopt;
  std::vector<double> r(problem.residuals), J(problem.residuals * n);
  if (!problem.model(found->at.data(), r.data(), J.data())) return std::nullopt;
  Calibration result;
  result.converged = found->converged;
  result.iterations = found->iterations;
  result.cost = found->cost;
  for (std::size_t i = 0; i < n; ++i) {
    const Constant& c = problem.constants[i];
    const double value = found->at[i];
    Estimate& e = result.estimates.emplace_back();
    e.name = c.name;
    e.unit = c.unit;
    e.value = value;
    e.standard_error = e.low = e.high = kUnknown;
    e.at_bound = is_at(value, c.low) || is_at(value, c.high);
  }
  add_intervals(problem, J, r, result);
  add_warnings(result);
  return result;
}

/// The problem with one constant held.
class Held {
 public:
  Held(const LeastSquares& problem, std::size_t held)
      : problem_(problem), held_(held), all_(problem.constants.size()) {
    reduced_ = problem;
    reduced_.constants.erase(reduced_.constants.begin() + static_cast<std::ptrdiff_t>(held));
    reduced_.model = [this](const double* c, double* r, double* J) { return evaluate(c, r, J); };
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  /// Cost of the best fit near `others`, which moves there; infinite where the model has no value.
  double cost(double value, std::vector<double>& others) {
    all_[held_] = value;
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
      if (i != held_) all_[i] = c[j++];
    std::vector<double> whole(J == nullptr ? 0 : problem_.residuals * n);
    if (!problem_.model(all_.data(), r, J == nullptr ? nullptr : whole.data())) return false;
    if (J == nullptr) return true;
    for (std::size_t row = 0; row < problem_.residuals; ++row)
      for (std::size_t i = 0, j = 0; i < n; ++i)
        if (i != held_) J[row * (n - 1) + j++] = whole[row * n + i];
    return true;
  }

  const LeastSquares& problem_;
  std::size_t held_;
  std::vector<double> all_;
  LeastSquares reduced_;
};

/// One end of a profile: from the best fit outwards until the cost has risen by `rise`.
class ProfileEnd {
 public:
  ProfileEnd(const LeastSquares& problem, const Calibration& best, std::size_t constant,
             double rise)
      : constant_(problem.constants[constant]),
        held_(problem, constant),
        value_(best.estimates[constant].value),
        allowed_(best.cost + rise),
        cost_(best.cost) {
    for (std::size_t i = 0; i < best.estimates.size(); ++i)
      if (i != constant) others_.push_back(best.estimates[i].value);
  }

  /// `step`: where the linearised interval ends, from the value. The bound, or infinity, when the
  /// profile has not got there at 4096 times the step.
  double find(double step) {
    constexpr int kDoublings = 12;
    const double bound = step > 0 ? constant_.high : constant_.low;
    double inside = value_, inside_excess = cost_ - allowed_;
    for (int i = 0; i < kDoublings; ++i, step *= 2) {
      const double reached = value_ + step;
      const bool past = step > 0 ? reached >= bound : reached <= bound;
      const double outside = past ? bound : reached;
      std::vector<double> others = others_;
      const double excess = held_.cost(outside, others) - allowed_;
      better_ = better_ || excess + allowed_ < cost_ * (1 - kSameCost);
      if (excess > 0) return between(inside, inside_excess, outside, excess);
      if (past) return bound;
      others_ = others;
      inside = outside;
      inside_excess = excess;
    }
    return step > 0 ? std::numeric_limits<double>::infinity()
                    : -std::numeric_limits<double>::infinity();
  }

  bool met_better_fit() const { return better_; }

 private:
  /// Regula falsi with halved weights [Dahlquist & Bjorck 1974, sec. 6.4].
  double between(double a, double excess_a, double b, double excess_b) {
    constexpr int kMost = 40;
    constexpr double kClose = 1e-4;  // of the distance from the best fit
    for (int i = 0; i < kMost && std::abs(b - a) > kClose * std::abs(b - value_); ++i) {
      const double middle =
          std::isfinite(excess_b) ? b - excess_b * (b - a) / (excess_b - excess_a) : 0.5 * (a + b);
      std::vector<double> others = others_;
      const double excess = held_.cost(middle, others) - allowed_;
      if (std::abs(excess) <= kClose * (allowed_ - cost_)) return middle;
      if (excess > 0) {
        b = middle;
        excess_b = excess;
        excess_a *= 0.5;
      } else {
        a = middle;
        excess_a = excess;
        if (std::isfinite(excess_b)) excess_b *= 0.5;
        others_ = others;
      }
    }
    return 0.5 * (a + b);
  }

  const Constant& constant_;
  Held held_;
  double value_, allowed_, cost_;
  std::vector<double> others_;  ///< of the last fit within the interval
  bool better_ = false;
};

/// Two sets of constants that fit alike but are not alike.
void warn_of_other_minimum(const std::vector<Calibration>& found, Calibration& best) {
  for (const Calibration& other : found) {
    if (!other.converged || other.cost > best.cost * (1 + kSameCost)) continue;
    bool apart = false;
    std::string text;
    for (std::size_t i = 0; i < other.estimates.size(); ++i) {
      const double a = best.estimates[i].value, b = other.estimates[i].value;
      apart = apart || std::abs(a - b) > 0.01 * (std::abs(a) + std::abs(b));
      text += (text.empty() ? "" : ", ") + other.estimates[i].name + " = " + text_of(b);
    }
    if (!apart) continue;
    best.warnings.push_back("another set of constants fits as well: " + text);
    return;
  }
}

}  // namespace

Calibration minimise(const LeastSquares& problem, const std::string& where) {
  check_problem(problem, where);
  const auto result = try_minimise(problem);
  if (result) return *result;
  refuse(where, "the model has no value near the start", "choose another start");
}

Calibration minimise(LeastSquares problem, const std::vector<std::vector<double>>& starts,
                     const std::string& where) {
  std::optional<Calibration> best;
  std::vector<Calibration> found;
  for (const std::vector<double>& start : starts) {
    for (std::size_t i = 0; i < start.size(); ++i) problem.constants[i].start = start[i];
    check_problem(problem, where);
    const auto result = try_minimise(problem);
    if (!result) continue;
    found.push_back(*result);
    if (!best || result->cost < best->cost * (1 - kSameCost)) best = result;
  }
  if (best) {
    warn_of_other_minimum(found, *best);
    return *best;
  }
  refuse(where, "the model has no value near any start", "give starts of the constants");
}

void add_profiles(const LeastSquares& problem, Calibration& result) {
  constexpr double kFar = 0.25;  // of the half width: how far an end is from the linearised one
  const bool estimated = !problem.known_scatter || result.widened;
  if (result.freedom <= 0) return;
  const double s = estimated ? result.scatter : 1;
  const double t = measured::student_quantile(problem.confidence, estimated ? result.freedom : 1e6);
  for (std::size_t i = 0; i < result.estimates.size(); ++i) {
    Estimate& e = result.estimates[i];
    const double half = e.high - e.value;
    if (e.at_bound || !(half > 0) || !std::isfinite(half)) continue;
    ProfileEnd below(problem, result, i, 0.5 * t * t * s * s);
    ProfileEnd above(problem, result, i, 0.5 * t * t * s * s);
    // Of a constant that is not determined the linearised interval can be any size.
    const double step = e.value != 0 ? std::min(half, std::abs(e.value)) : half;
    e.profile_low = below.find(-step);
    e.profile_high = above.find(step);
    const std::string ends = text_of(e.profile_low) + " to " + text_of(e.profile_high);
    if (below.met_better_fit() || above.met_better_fit()) {
      result.warnings.push_back("away from the best " + e.name +
                                " there is a better fit: choose other starts");
    } else if (!std::isfinite(e.profile_high - e.profile_low)) {
      result.warnings.push_back(e.name + " is not bounded by the data: its profile goes from " +
                                ends);
    } else if (std::max(std::abs(e.profile_low - e.low), std::abs(e.profile_high - e.high)) >
               kFar * half) {
      result.warnings.push_back("the interval of " + e.name +
                                " is not symmetric: its profile goes from " + ends);
    }
  }
}

}  // namespace palpate::calibrate
