// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/multiplier_path.hpp"

#include "fem/solve/extrapolation.hpp"

namespace palpate::fem {

namespace {

constexpr std::size_t kMostStates = 4;

}  // namespace

void MultiplierPath::start(const Eigen::Vector3d& tip, const std::vector<double>& multipliers) {
  travel_.assign(1, 0.0);
  multipliers_.assign(1, multipliers);
  tip_ = tip;
}

void MultiplierPath::add(const Eigen::Vector3d& tip, const std::vector<double>& multipliers) {
  const double travel = travel_to(tip);
  if (!(travel > travel_.back())) return start(tip, multipliers);
  if (travel_.size() == kMostStates) {
    travel_.erase(travel_.begin());
    multipliers_.erase(multipliers_.begin());
  }
  travel_.push_back(travel);
  multipliers_.push_back(multipliers);
  tip_ = tip;
}

std::vector<double> MultiplierPath::predict(const Eigen::Vector3d& tip) const {
  const std::vector<double> weights = extrapolation_weights(travel_, travel_to(tip));
  std::vector<double> predicted(last().size(), 0.0);
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (std::size_t e = 0; e < predicted.size(); ++e)
      predicted[e] += weights[i] * multipliers_[i][e];
  return predicted;
}

}  // namespace palpate::fem
