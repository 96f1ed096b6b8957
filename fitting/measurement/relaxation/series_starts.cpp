// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/relaxation/series_starts.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <optional>

namespace palpate::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Inner products of e, the memories and the measured force.
struct Products {
  MatrixXd gram;
  VectorXd with_force;
  double force_squared = 0;
};

VectorXd vector_of(const std::vector<double>& v) {
  return Eigen::Map<const VectorXd>(v.data(), static_cast<Index>(v.size()));
}

Products products_of(const HistoryModel& model, double exponent, const std::vector<double>& times) {
  MatrixXd columns(static_cast<Index>(model.record().time.size()),
                   static_cast<Index>(times.size()) + 1);
  columns.col(0) = vector_of(model.elastic(exponent));
  for (std::size_t i = 0; i < times.size(); ++i)
    columns.col(static_cast<Index>(i) + 1) = vector_of(model.memory(exponent, times[i]));
  const VectorXd force = vector_of(model.record().force);
  return {columns.transpose() * columns, columns.transpose() * force, force.squaredNorm()};
}

/// The best amplitudes of e and of the memories `chosen`; none where one is not positive.
std::optional<SeriesStart> solve(const Products& p, const std::vector<std::size_t>& chosen) {
  const auto n = static_cast<Index>(chosen.size()) + 1;
  const auto of = [&](Index i) {
    return i == 0 ? Index{0} : static_cast<Index>(chosen[static_cast<std::size_t>(i - 1)]) + 1;
  };
  MatrixXd gram(n, n);
  VectorXd right(n);
  for (Index i = 0; i < n; ++i) {
    right[i] = p.with_force[of(i)];
    for (Index j = 0; j < n; ++j) gram(i, j) = p.gram(of(i), of(j));
  }
  const VectorXd amplitude = gram.ldlt().solve(right);
  if (!(amplitude.minCoeff() > 0)) return std::nullopt;
  SeriesStart start;
  start.force = amplitude.sum();
  for (Index i = 1; i < n; ++i) start.fraction.push_back(amplitude[i] / start.force);
  start.misfit = p.force_squared - right.dot(amplitude);
  return start;
}

/// The next set of `chosen` of `count` indices in lexicographic order; false after the last.
bool advance(std::vector<std::size_t>& chosen, std::size_t count) {
  for (std::size_t k = chosen.size(); k-- > 0;) {
    if (chosen[k] + (chosen.size() - k) >= count) continue;
    ++chosen[k];
    for (std::size_t j = k + 1; j < chosen.size(); ++j) chosen[j] = chosen[j - 1] + 1;
    return true;
  }
  return false;
}

}  // namespace

std::vector<SeriesStart> series_starts(const HistoryModel& model,
                                       const std::vector<double>& exponents,
                                       const std::vector<double>& times, std::size_t terms,
                                       std::size_t few) {
  std::vector<SeriesStart> starts;
  if (terms > times.size()) return starts;
  for (const double exponent : exponents) {
    const Products products = products_of(model, exponent, times);
    std::vector<std::size_t> chosen(terms);
    for (std::size_t i = 0; i < terms; ++i) chosen[i] = i;
    do {
      auto start = solve(products, chosen);
      if (!start) continue;
      start->exponent = exponent;
      for (const std::size_t i : chosen) start->time.push_back(times[i]);
      starts.push_back(*start);
    } while (advance(chosen, times.size()));
  }
  std::sort(starts.begin(), starts.end(),
            [](const SeriesStart& a, const SeriesStart& b) { return a.misfit < b.misfit; });
  if (starts.size() > few) starts.resize(few);
  return starts;
}

}  // namespace palpate::calibrate
