// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/relaxation/branch_stresses.hpp"

#include <cmath>
#include <utility>

#include "format/to_index.hpp"

namespace palpate::fem {

BranchStresses::BranchStresses(RegionRelaxation relaxation, std::vector<std::int32_t> region)
    : relaxation_(std::move(relaxation)),
      region_(std::move(region)),
      S_(region_.size()),
      Q_(relaxation_.times_s.size(), StressField(region_.size())) {}

double BranchStresses::fraction(std::size_t element, std::size_t branch) const {
  return relaxation_.fractions[to_index(region_[element])][branch];
}

HistoryStress BranchStresses::step(double h) const {
  HistoryStress step;
  for (const std::vector<double>& fractions : relaxation_.fractions) {
    double c = 1;
    for (std::size_t i = 0; i < fractions.size(); ++i)
      c -= fractions[i] * (1 - std::exp(-h / (2 * relaxation_.times_s[i])));
    step.factor.push_back(c);
  }
  step.stress.assign(region_.size(), {});
  for (std::size_t i = 0; i < Q_.size(); ++i) {
    const double decay = std::exp(-h / relaxation_.times_s[i]), middle = std::sqrt(decay);
    for (std::size_t e = 0; e < region_.size(); ++e) {
      const double g = fraction(e, i) * middle;
      for (std::size_t q = 0; q < kTetPoints; ++q)
        for (std::size_t entry = 0; entry < 6; ++entry)
          step.stress[e][q][entry] += decay * Q_[i][e][q][entry] - g * S_[e][q][entry];
    }
  }
  return step;
}

void BranchStresses::advance(double h, const StressField& S) {
  for (std::size_t i = 0; i < Q_.size(); ++i) {
    const double decay = std::exp(-h / relaxation_.times_s[i]), middle = std::sqrt(decay);
    for (std::size_t e = 0; e < region_.size(); ++e) {
      const double g = fraction(e, i) * middle;
      for (std::size_t q = 0; q < kTetPoints; ++q)
        for (std::size_t entry = 0; entry < 6; ++entry)
          Q_[i][e][q][entry] = decay * Q_[i][e][q][entry] + g * (S[e][q][entry] - S_[e][q][entry]);
    }
  }
  S_ = S;
}

}  // namespace palpate::fem
