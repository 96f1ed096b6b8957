// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/predictor.hpp"

#include "fem/solve/extrapolation.hpp"
#include "fem/solve/profile.hpp"

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
  const auto first = states_.end() - static_cast<std::ptrdiff_t>(count);
  std::vector<double> travel;
  for (auto state = first; state != states_.end(); ++state) travel.push_back(state->s);
  const std::vector<double> weights = extrapolation_weights(travel, s);
  Displacement u = Displacement::Zero(3, states_.back().u.cols());
  for (std::size_t i = 0; i < count; ++i) u += weights[i] * first[static_cast<std::ptrdiff_t>(i)].u;
  return u;
}

Displacement Predictor::predict(const SolidModel& model, double s) const {
  for (std::size_t count = states_.size(); count > 1; --count) {
    Displacement u = extrapolate(s, count);
    const PartTimer timer(Part::BodyPasses);
    if (model.energy(u).min_J > kSmallestJ) return u;
  }
  return last();
}

}  // namespace palpate::fem
