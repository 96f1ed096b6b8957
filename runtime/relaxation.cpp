// SPDX-License-Identifier: Apache-2.0
#include "runtime/relaxation.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::runtime {

NormalMemory Relaxation::sums(const Branches& fractions) const noexcept {
  double mean = 0, square = 0;
  for (std::size_t i = 0; i < surface_->relaxation_times().size(); ++i) {
    mean += fractions[i] * memory_[i];
    square += fractions[i] * memory_[i] * memory_[i];
  }
  return {mean, std::max(square - mean * mean, 0.0) / 2, 1};
}

NormalMemory Relaxation::carried_to(const SurfacePoint& p, double distance) const noexcept {
  if (!remembers()) return {};
  NormalMemory there = surface_->relaxes_alike() ? now_ : sums(surface_->fractions(p));
  double factor = std::exp(-distance / surface_->tool_radius());
  if (there.locked > now_.locked) factor *= std::sqrt(now_.locked / there.locked);
  there.relaxed *= factor;
  there.locked *= factor * factor;
  there.carried = factor;
  return there;
}

void Relaxation::carry(const SurfacePoint& p, const NormalMemory& carried) noexcept {
  if (carried.carried != 1)
    for (double& a : memory_) a *= carried.carried;
  if (!surface_->relaxes_alike() || fractions_[0] == 0) fractions_ = surface_->fractions(p);
  now_ = carried;
  now_.carried = 1;
}

void Relaxation::keep_decay(double dt) noexcept {
  if (dt == decay_dt_) return;
  decay_dt_ = dt;
  const auto& times = surface_->relaxation_times();
  for (std::size_t i = 0; i < times.size(); ++i) decay_[i] = std::exp(-dt / times[i]);
}

void Relaxation::pass(double y, double dt) noexcept {
  keep_decay(dt);
  const double skin = std::max(y, now_.relaxed);
  for (std::size_t i = 0; i < surface_->relaxation_times().size(); ++i)
    memory_[i] = skin + (memory_[i] - skin) * decay_[i];
  now_ = sums(fractions_);
}

void Relaxation::forget() noexcept {
  memory_ = {};
  now_ = {};
}

}  // namespace palpate::runtime
