// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/predictor.hpp"

namespace palpate::fem {

namespace {

constexpr std::size_t kMaxStates = 4;
constexpr double kSmallestJ = 0.3;  ///< det F, so that no element is near inversion

}  // namespace

void Predictor::add(double s, const Displacement& u) {
  if (states_.size() == kMaxStates) states_.erase(states_.begin());
  states_.push_back({s, u});
}

Displacement Predictor::extrapolate(double s, std::size_t count) const {
  const auto first = states_.size() - count;
  Displacement u = Displacement::Zero(3, states_.back().u.cols());
  for (auto i = first; i < states_.size(); ++i) {
    double weight = 1;
    for (auto j = first; j < states_.size(); ++j)
      if (j != i) weight *= (s - states_[j].s) / (states_[i].s - states_[j].s);
    u += weight * states_[i].u;
  }
  return u;
}

Displacement Predictor::predict(const SolidModel& model, double s) const {
  for (std::size_t count = states_.size(); count > 1; --count) {
    Displacement u = extrapolate(s, count);
    if (model.energy(u).min_J > kSmallestJ) return u;
  }
  return last();
}

}  // namespace palpate::fem
