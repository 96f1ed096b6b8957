// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/curve_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "fitting/response/nnls.hpp"
#include "format/error.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

using Knots = std::vector<double>;
using Samples = std::vector<ForceSample>;

double tolerance(const ForceSample& sample, const CurveFitSettings& settings) {
  return std::max(settings.relative_tolerance * std::abs(sample.force),
                  settings.absolute_tolerance);
}

/// f(d) = row . s: the integral from 0 to d of the piecewise linear slope.
Eigen::RowVectorXd force_row(const Knots& knots, double d) {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(knots.size()));
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const double h = knots[k + 1] - knots[k];
    const double into = std::clamp(d - knots[k], 0.0, h);
    const double right = into * into / (2 * h);
    row[static_cast<Eigen::Index>(k)] += into - right;
    row[static_cast<Eigen::Index>(k) + 1] += right;
  }
  row[row.size() - 1] += std::max(0.0, d - knots.back());
  return row;
}

/// Row of the kink penalty at interior knot k.
Eigen::RowVectorXd kink_row(const Knots& knots, std::size_t k, double largest_tolerance) {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(knots.size()));
  const double left = knots[k] - knots[k - 1];
  const double right = knots[k + 1] - knots[k];
  const double scale = 0.25 * (left + right) * (left + right) * kKinkWeight / largest_tolerance;
  const auto i = static_cast<Eigen::Index>(k);
  row[i - 1] = scale / left;
  row[i] = -scale * (1 / left + 1 / right);
  row[i + 1] = scale / right;
  return row;
}

/// Row that makes the slopes of a piece even, where samples and kinks leave them open.
Eigen::RowVectorXd even_row(const Knots& knots, std::size_t k, double largest_tolerance) {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(knots.size()));
  const double scale = (knots[k + 1] - knots[k]) * kEvenWeight / largest_tolerance;
  const auto i = static_cast<Eigen::Index>(k);
  row[i] = -scale;
  row[i + 1] = scale;
  return row;
}

/// A piece with fewer samples could take any slope in its middle.
constexpr std::size_t kSamplesPerPiece = 2;

struct Candidate {
  Knots knots;
  ResponseCurve curve;
  std::vector<double> ratio;  ///< error over tolerance at each sample
  double worst = 0;
};

ResponseCurve rounded(const Knots& knots, const std::vector<double>& slopes) {
  ResponseCurve curve;
  for (const double d : knots) curve.knot.push_back(static_cast<float>(d));
  for (const double s : slopes) curve.slope.push_back(static_cast<float>(s));
  return curve;
}

class KnotSearch {
 public:
  KnotSearch(const Samples& samples, const CurveFitSettings& settings)
      : samples_(samples), settings_(settings), depth_(samples.back().displacement) {}

  Candidate run() const {
    std::vector<Candidate> tried{evaluate({0, depth_})};
    while (tried.back().worst > 1 && tried.back().knots.size() < knot_limit()) {
      const std::optional<Candidate> finer = split(tried.back());
      if (!finer) break;
      tried.push_back(shift_knots(*finer));
    }
    return tried.back().worst <= 1 ? drop_knots(tried.back()) : by_schwarz_criterion(tried);
  }

 private:
  Candidate evaluate(const Knots& knots) const {
    Candidate result{knots, rounded(knots, fit_slopes(samples_, knots, settings_)), {}, 0};
    const runtime::CompiledCurve rendered(result.curve);
    for (const ForceSample& sample : samples_) {
      const double error = rendered.force(sample.displacement) - sample.force;
      result.ratio.push_back(std::abs(error) / tolerance(sample, settings_));
      result.worst = std::max(result.worst, result.ratio.back());
    }
    return result;
  }

  std::size_t knot_limit() const {
    const std::size_t touch = settings_.zero_first_slope ? 2 : 1;
    const std::size_t supported = touch + samples_.size() / kSamplesPerPiece;
    return std::max<std::size_t>(
        2, std::min(static_cast<std::size_t>(settings_.max_knots), supported));
  }

  /// For samples that scatter by more than the tolerance, or when the knots are used up: the
  /// candidate of the smallest n ln(S/n) + p ln n [Schwarz 1978], S the sum of squares and p two
  /// numbers a knot. More knots would follow the noise.
  Candidate by_schwarz_criterion(const std::vector<Candidate>& tried) const {
    const auto n = static_cast<double>(samples_.size());
    std::size_t chosen = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < tried.size(); ++i) {
      double sum = 0;
      for (const double ratio : tried[i].ratio) sum += ratio * ratio;
      const double numbers = 2 * static_cast<double>(tried[i].knots.size());
      const double criterion = n * std::log(sum / n) + numbers * std::log(n);
      if (criterion < least) {
        least = criterion;
        chosen = i;
      }
    }
    return tried[chosen];
  }

  bool supported(const Knots& knots) const {
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      if (knots[k + 1] - knots[k] < gap()) return false;
      const auto inside = [&](const ForceSample& sample) {
        return sample.displacement > knots[k] && sample.displacement <= knots[k + 1];
      };
      const auto count = std::count_if(samples_.begin(), samples_.end(), inside);
      // Zero slope at touch constrains the first piece of a normal response. It has to be short to
      // represent the square root in the slope of a round tool.
      const std::size_t constraints = k == 0 && settings_.zero_first_slope ? kSamplesPerPiece : 0;
      if (static_cast<std::size_t>(count) + constraints < kSamplesPerPiece) return false;
    }
    return true;
  }

  /// Adds one knot, at a sample or before the first, where it lowers the largest error most. Absent
  /// when no piece has enough samples to be split.
  std::optional<Candidate> split(const Candidate& candidate) const {
    std::optional<Candidate> best;
    std::vector<double> positions{0.5 * samples_.front().displacement};
    for (const ForceSample& sample : samples_) positions.push_back(sample.displacement);
    for (const double d : positions) {
      Knots knots = candidate.knots;
      knots.insert(std::upper_bound(knots.begin(), knots.end(), d), d);
      if (!supported(knots)) continue;
      Candidate finer = evaluate(knots);
      if (!best || finer.worst < best->worst) best = std::move(finer);
    }
    return best;
  }

  /// Moves interior knots, one at a time, while that lowers the largest error.
  Candidate shift_knots(Candidate best) const {
    for (int sweep = 0; sweep < 6 && best.worst > 1; ++sweep) {
      const double before = best.worst;
      for (std::size_t k = 1; k + 1 < best.knots.size(); ++k) best = shift_knot(best, k);
      if (best.worst > 0.98 * before) break;
    }
    return best;
  }

  Candidate shift_knot(Candidate best, std::size_t k) const {
    for (const double fraction : {0.4, -0.4, 0.15, -0.15, 0.05, -0.05}) {
      Knots knots = best.knots;
      const std::size_t neighbour = fraction > 0 ? k + 1 : k - 1;
      knots[k] += std::abs(fraction) * (knots[neighbour] - knots[k]);
      if (!supported(knots)) continue;
      Candidate moved = evaluate(knots);
      if (moved.worst < best.worst) best = std::move(moved);
    }
    return best;
  }

  /// Removes the least important knots while all samples stay within tolerance.
  Candidate drop_knots(Candidate best) const {
    while (best.worst <= 1 && best.knots.size() > 2) {
      std::optional<Candidate> without;
      for (std::size_t k = 1; k + 1 < best.knots.size(); ++k) {
        Knots knots = best.knots;
        knots.erase(knots.begin() + static_cast<std::ptrdiff_t>(k));
        Candidate dropped = shift_knots(evaluate(knots));
        if (!without || dropped.worst < without->worst) without = std::move(dropped);
      }
      if (without->worst > 1) break;
      best = std::move(*without);
    }
    return best;
  }

  /// Smallest distance between knots: about the spacing of the samples, and far above single
  /// precision.
  double gap() const {
    return std::max(1e-3 * depth_, 0.25 * std::min(samples_.front().displacement,
                                                   depth_ / static_cast<double>(samples_.size())));
  }

  const Samples& samples_;
  CurveFitSettings settings_;
  double depth_;
};

/// Where the force between two samples is computed from its mean, over their distance.
constexpr std::array kBetween{0.25, 0.5, 0.75};

/// Relative distance below which two displacements differ only by rounding.
constexpr double kSame = 1e-9;

/// The force at a fraction of the way from `low` to a sample that knows the mean between: a
/// parabola, or from the start of the curve, where the force of a round tool is none, a power.
double force_between(const ForceSample& low, const ForceSample& high, double fraction) {
  constexpr double kLowest = 0.5, kHighest = 3;  // exponents
  const double exponent = high.force / high.mean - 1;
  if (low.displacement == 0 && exponent >= kLowest && exponent <= kHighest)
    return high.force * std::pow(fraction, exponent);
  const double bow = high.mean - 0.5 * (low.force + high.force);
  return low.force + fraction * (high.force - low.force) + 6 * fraction * (1 - fraction) * bow;
}

Samples checked(Samples samples, const std::string& where) {
  for (const ForceSample& sample : samples) {
    if (std::isfinite(sample.displacement) && std::isfinite(sample.force)) continue;
    throw Error(ErrorKind::Configuration, where, "a sample is not a finite number",
                "check the file the curves come from");
  }
  // The response is 0 at 0 by definition, so a sample there is redundant.
  std::erase_if(samples, [](const ForceSample& sample) { return !(sample.displacement > 0); });
  std::sort(samples.begin(), samples.end(), [](const ForceSample& a, const ForceSample& b) {
    return a.displacement < b.displacement;
  });
  if (samples.empty()) {
    throw Error(ErrorKind::Configuration, where, "no sample with a displacement above zero",
                "leave the site out or measure it again");
  }
  return samples;
}

}  // namespace

CurveFitSettings settled(CurveFitSettings settings, const std::vector<ForceSample>& samples) {
  if (!std::isnan(settings.absolute_tolerance)) return settings;
  double peak = 0;
  for (const ForceSample& sample : samples) peak = std::max(peak, std::abs(sample.force));
  // Any tolerance suits samples without a force: the curve without a slope meets them.
  settings.absolute_tolerance = peak > 0 ? kPeakFraction * peak : 1;
  return settings;
}

std::vector<ForceSample> with_forces_between(const std::vector<ForceSample>& samples) {
  Samples dense;
  ForceSample low{0, 0};
  for (const ForceSample& high : samples) {
    const double travel = high.displacement - low.displacement;
    const bool known = std::isfinite(high.mean) && travel > 0 &&
                       std::abs(high.since - low.displacement) <= kSame * high.displacement;
    for (const double fraction : kBetween) {
      if (!known) break;
      dense.push_back({low.displacement + fraction * travel, force_between(low, high, fraction)});
    }
    dense.push_back(high);
    low = high;
  }
  return dense;
}

std::vector<double> fit_slopes(const std::vector<ForceSample>& samples,
                               const std::vector<double>& knots, const CurveFitSettings& settings) {
  const auto rows = static_cast<Eigen::Index>(samples.size());
  const auto columns = static_cast<Eigen::Index>(knots.size());
  double largest = 0;
  for (const ForceSample& sample : samples)
    largest = std::max(largest, tolerance(sample, settings));

  const Eigen::Index kinks = columns - 2, pieces = columns - 1;
  Eigen::MatrixXd A(rows + kinks + pieces, columns);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(A.rows());
  for (Eigen::Index i = 0; i < rows; ++i) {
    const ForceSample& sample = samples[static_cast<std::size_t>(i)];
    const double t = tolerance(sample, settings);
    A.row(i) = force_row(knots, sample.displacement) / t;
    b[i] = sample.force / t;
  }
  for (Eigen::Index k = 1; k + 1 < columns; ++k) {
    A.row(rows + k - 1) = kink_row(knots, static_cast<std::size_t>(k), largest);
  }
  for (Eigen::Index k = 0; k < pieces; ++k) {
    A.row(rows + kinks + k) = even_row(knots, static_cast<std::size_t>(k), largest);
  }
  const Eigen::Index pinned = settings.zero_first_slope ? 1 : 0;
  const Eigen::VectorXd free = nonnegative_least_squares(A.rightCols(columns - pinned), b);
  std::vector<double> slopes(knots.size(), 0.0);
  for (Eigen::Index k = pinned; k < columns; ++k) {
    slopes[static_cast<std::size_t>(k)] = free[k - pinned];
  }
  return slopes;
}

CurveFit fit_curve(std::vector<ForceSample> samples, const CurveFitSettings& given,
                   const std::string& where) {
  const Samples usable = checked(std::move(samples), where);
  const CurveFitSettings settings = settled(given, usable);
  const Samples dense = with_forces_between(usable);
  const Candidate best = KnotSearch(dense, settings).run();
  const runtime::CompiledCurve rendered(best.curve);
  CurveFit fit{best.curve, 0, best.worst};
  for (const ForceSample& sample : usable)
    fit.largest_error =
        std::max(fit.largest_error, std::abs(rendered.force(sample.displacement) - sample.force));
  return fit;
}

}  // namespace palpate::fitting
