// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/scan.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace palpate::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Logarithms of stretches are scanned up to powers of exp(this).
constexpr double kLargestPower = 40;
/// Columns that are this close to being dependent are one.
constexpr double kDependent = 1e-10;

struct Range {
  double strain = 0;     ///< largest principal logarithmic strain
  double invariant = 0;  ///< largest I1 - 3
};

Range range_of(const std::vector<WeightedSample>& samples) {
  Range range;
  for (const WeightedSample& s : samples) {
    for (const double e : logarithmic_strains(s.mode, s.deformation))
      range.strain = std::max(range.strain, std::abs(e));
    range.invariant = std::max(range.invariant, first_invariant(s.mode, s.deformation));
  }
  range.strain = std::max(range.strain, 1e-6);
  range.invariant = std::max(range.invariant, 1e-12);
  return range;
}

/// `count` numbers from low to high, evenly spaced by their logarithms.
std::vector<double> spaced(double low, double high, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(low * std::pow(high / low, i / (count - 1.0)));
  return out;
}

/// The weighted problem without what offsets of the tests can take up.
class Weighted {
 public:
  Weighted(const std::vector<WeightedSample>& samples, const std::vector<bool>& offset)
      : samples_(samples), offset_(offset), factor_(static_cast<Index>(samples.size())) {
    VectorXd stress(factor_.size());
    for (Index i = 0; i < factor_.size(); ++i) {
      const WeightedSample& s = samples[static_cast<std::size_t>(i)];
      factor_[i] = s.factor;
      stress[i] = s.stress;
    }
    measured_ = without_offsets(factor_.cwiseProduct(stress));
  }

  const VectorXd& measured() const { return measured_; }

  VectorXd column(const std::function<double(const WeightedSample&)>& stress) const {
    VectorXd out(factor_.size());
    for (Index i = 0; i < out.size(); ++i)
      out[i] = factor_[i] * stress(samples_[static_cast<std::size_t>(i)]);
    return without_offsets(out);
  }

 private:
  VectorXd without_offsets(VectorXd v) const {
    for (std::size_t test = 0; test < offset_.size(); ++test) {
      if (!offset_[test]) continue;
      double above = 0, below = 0;
      for (Index i = 0; i < v.size(); ++i) {
        if (samples_[static_cast<std::size_t>(i)].test != test) continue;
        above += factor_[i] * v[i];
        below += factor_[i] * factor_[i];
      }
      for (Index i = 0; i < v.size(); ++i)
        if (samples_[static_cast<std::size_t>(i)].test == test) v[i] -= above / below * factor_[i];
    }
    return v;
  }

  const std::vector<WeightedSample>& samples_;
  const std::vector<bool>& offset_;
  VectorXd factor_, measured_;
};

struct Candidate {
  double cost = 0;
  std::vector<int> at;           ///< places in the scan
  std::vector<double> linear{};  ///< constants
};

/// The cheapest candidates, none with only neighbours of a better one.
std::vector<Candidate> best_of(std::vector<Candidate> all, std::size_t most) {
  // Of exponents that fit alike, as those of either sign do in pure shear, the first of the scan.
  const auto key = [](const Candidate& c) {
    return std::pair(std::llround(1e6 * std::log(std::max(c.cost, 1e-300))), c.at);
  };
  std::sort(all.begin(), all.end(),
            [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); });
  std::vector<Candidate> best;
  for (const Candidate& candidate : all) {
    const auto near = [&](const Candidate& other) {
      for (std::size_t i = 0; i < candidate.at.size(); ++i)
        if (std::abs(candidate.at[i] - other.at[i]) > 1) return false;
      return true;
    };
    if (std::any_of(best.begin(), best.end(), near)) continue;
    best.push_back(candidate);
    if (best.size() == most) break;
  }
  return best;
}

/// Columns of unit length and what they share with each other and with the measured stresses.
struct Gram {
  MatrixXd products;
  VectorXd measured, length;
  double squares = 0;

  Gram(const std::vector<VectorXd>& columns, const VectorXd& stress)
      : products(columns.size(), columns.size()),
        measured(columns.size()),
        length(columns.size()),
        squares(stress.squaredNorm()) {
    MatrixXd unit(stress.size(), static_cast<Index>(columns.size()));
    for (Index i = 0; i < unit.cols(); ++i) {
      const VectorXd& column = columns[static_cast<std::size_t>(i)];
      length[i] = column.norm();
      unit.col(i) = length[i] > 0 ? VectorXd(column / length[i]) : column;
    }
    products = unit.transpose() * unit;
    measured = unit.transpose() * stress;
  }

  /// Least squares over the columns `of`; none where they are dependent.
  std::optional<Candidate> solve(const std::vector<int>& of) const {
    const auto n = static_cast<Index>(of.size());
    MatrixXd normal(n, n);
    VectorXd right(n);
    for (Index i = 0; i < n; ++i) {
      right[i] = measured[of[static_cast<std::size_t>(i)]];
      for (Index j = 0; j < n; ++j)
        normal(i, j) = products(of[static_cast<std::size_t>(i)], of[static_cast<std::size_t>(j)]);
    }
    const Eigen::LDLT<MatrixXd> factor(normal);
    if (!(factor.vectorD().minCoeff() > kDependent)) return std::nullopt;
    const VectorXd x = factor.solve(right);
    Candidate candidate{squares - x.dot(right), of, {}};
    for (Index i = 0; i < n; ++i)
      candidate.linear.push_back(x[i] / length[of[static_cast<std::size_t>(i)]]);
    return candidate;
  }

  /// The same with none below zero: the best over the subsets of the columns whose solution is so.
  std::optional<Candidate> solve_positive(const std::vector<int>& of) const {
    std::optional<Candidate> best;
    for (unsigned subset = 1; subset < 1U << of.size(); ++subset) {
      std::vector<int> used;
      for (std::size_t i = 0; i < of.size(); ++i)
        if ((subset >> i & 1U) != 0) used.push_back(of[i]);
      const auto found = solve(used);
      if (!found || (best && found->cost >= best->cost)) continue;
      if (*std::min_element(found->linear.begin(), found->linear.end()) < 0) continue;
      best = Candidate{found->cost, of, std::vector<double>(of.size(), 0)};
      for (std::size_t i = 0, j = 0; i < of.size(); ++i)
        if ((subset >> i & 1U) != 0) best->linear[i] = found->linear[j++];
    }
    return best;
  }
};

/// The exponents that are scanned, positive ones first.
std::vector<double> scanned_exponents(const Range& range) {
  constexpr double kMost = 99;  // of an exponent, by the table of laws
  const double high = std::clamp(kLargestPower / range.strain, 8.0, kMost);
  std::vector<double> alphas = spaced(0.5, high, 14);
  for (const double alpha : spaced(0.5, high, 14)) alphas.push_back(-alpha);
  return alphas;
}

/// What terms of unit modulus with these exponents share with each other and with the data.
Gram gram_of(const std::vector<double>& alphas, const Weighted& problem) {
  std::vector<VectorXd> columns;
  const IncompressibleLaw one("ogden-1");
  for (const double alpha : alphas) {
    const double constants[2] = {1, alpha};
    columns.push_back(problem.column(
        [&](const WeightedSample& s) { return one.stress(constants, s.mode, s.deformation); }));
  }
  return {columns, problem.measured()};
}

std::optional<Candidate> solve(const Gram& gram, const std::vector<int>& of, bool any_sign) {
  const auto found = any_sign ? gram.solve(of) : gram.solve_positive(of);
  return found && std::isfinite(found->cost) ? found : std::nullopt;
}

std::vector<double> constants_of(const Candidate& candidate, const std::vector<double>& alphas) {
  std::vector<double> c;
  for (std::size_t i = 0; i < candidate.at.size(); ++i) {
    c.push_back(candidate.linear[i]);
    c.push_back(alphas[static_cast<std::size_t>(candidate.at[i])]);
  }
  return c;
}

std::vector<std::vector<double>> ogden_starts(std::size_t terms, const Weighted& problem,
                                              const Range& range, const ScanSettings& settings) {
  const std::vector<double> alphas = scanned_exponents(range);
  const Gram gram = gram_of(alphas, problem);
  std::vector<Candidate> all;
  std::vector<int> at;
  const std::function<void(int)> choose = [&](int first) {
    if (at.size() == terms) {
      if (const auto found = solve(gram, at, settings.any_sign)) all.push_back(*found);
      return;
    }
    for (int i = first; i < static_cast<int>(alphas.size()); ++i) {
      at.push_back(i);
      choose(i + 1);
      at.pop_back();
    }
  };
  choose(0);
  std::vector<std::vector<double>> starts;
  for (const Candidate& candidate : best_of(std::move(all), settings.starts))
    starts.push_back(constants_of(candidate, alphas));
  return starts;
}

/// The exponents, or limits, of a law with a modulus and one such constant; none for other laws.
std::vector<double> second_constants(std::string_view law, const Range& range) {
  constexpr int kCount = 32;
  if (law == "demiray-fung" || law == "veronda-westmann")
    return spaced(1e-3 / range.invariant, std::min(900.0, kLargestPower / range.invariant), kCount);
  if (law == "gent") return spaced(1.001 * range.invariant, 1e3 * range.invariant, kCount);
  if (law == "arruda-boyce") {
    std::vector<double> stretches;  // beyond that of the unstretched chain
    const double chain = std::sqrt(1 + range.invariant / 3);
    for (const double more : spaced(0.02, 100, kCount)) stretches.push_back(1 + more * chain);
    return stretches;
  }
  return {};
}

std::vector<std::vector<double>> modulus_starts(const IncompressibleLaw& law,
                                                const std::vector<double>& seconds,
                                                const Weighted& problem,
                                                const ScanSettings& settings) {
  std::vector<Candidate> all;
  for (int i = 0; i < static_cast<int>(seconds.size()); ++i) {
    const double constants[2] = {1, seconds[static_cast<std::size_t>(i)]};
    const VectorXd column = problem.column(
        [&](const WeightedSample& s) { return law.stress(constants, s.mode, s.deformation); });
    if (!column.allFinite()) continue;
    const auto found = Gram({column}, problem.measured()).solve_positive({0});
    if (found) all.push_back({found->cost, {i}, found->linear});
  }
  std::vector<std::vector<double>> starts;
  for (const Candidate& candidate : best_of(std::move(all), settings.starts))
    starts.push_back({candidate.linear[0], seconds[static_cast<std::size_t>(candidate.at[0])]});
  return starts;
}

/// The solution of a law that is linear in its constants.
std::vector<double> linear_start(const IncompressibleLaw& law, const Weighted& problem) {
  const std::size_t n = law.constants().size();
  MatrixXd columns(problem.measured().size(), static_cast<Index>(n));
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> unit(n, 0);
    unit[k] = 1;
    columns.col(static_cast<Index>(k)) = problem.column(
        [&](const WeightedSample& s) { return law.stress(unit.data(), s.mode, s.deformation); });
  }
  const VectorXd x = columns.colPivHouseholderQr().solve(problem.measured());
  return {x.data(), x.data() + x.size()};
}

}  // namespace

double first_invariant(Mode mode, double deformation) {
  double sum = -3;
  for (const double e : logarithmic_strains(mode, deformation)) sum += std::exp(2 * e);
  return sum;
}

std::vector<std::vector<double>> scanned_starts(const IncompressibleLaw& law,
                                                const std::vector<WeightedSample>& samples,
                                                const ScanSettings& settings) {
  const Weighted problem(samples, settings.offset);
  const Range range = range_of(samples);
  if (law.name().starts_with("ogden"))
    return ogden_starts(law.constants().size() / 2, problem, range, settings);
  const std::vector<double> seconds = second_constants(law.name(), range);
  if (!seconds.empty()) return modulus_starts(law, seconds, problem, settings);
  return {linear_start(law, problem)};
}

std::vector<std::vector<double>> exchanged_terms(const IncompressibleLaw& law,
                                                 const std::vector<WeightedSample>& samples,
                                                 const std::vector<double>& constants,
                                                 const ScanSettings& settings) {
  if (!law.name().starts_with("ogden")) return {};
  constexpr std::size_t kEach = 2;
  const Weighted problem(samples, settings.offset);
  std::vector<double> alphas = scanned_exponents(range_of(samples));
  const int scanned = static_cast<int>(alphas.size());
  const auto terms = static_cast<int>(law.constants().size() / 2);
  for (int i = 0; i < terms; ++i) alphas.push_back(constants[2 * static_cast<std::size_t>(i) + 1]);
  const Gram gram = gram_of(alphas, problem);
  std::vector<std::vector<double>> starts;
  for (int i = 0; i < terms; ++i) {
    std::vector<Candidate> all;
    for (int other = 0; other < scanned; ++other) {
      std::vector<int> at;
      for (int k = 0; k < terms; ++k) at.push_back(k == i ? other : scanned + k);
      if (const auto found = solve(gram, at, settings.any_sign)) all.push_back(*found);
    }
    for (const Candidate& candidate : best_of(std::move(all), kEach))
      starts.push_back(constants_of(candidate, alphas));
  }
  return starts;
}

}  // namespace palpate::calibrate
