// SPDX-License-Identifier: Apache-2.0
#include "runtime/energy_rule.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::runtime {
namespace {

constexpr int kMostIterations = 64;
constexpr double kRelativeEquality = 1e-9;

struct EnergyAtOffset {
  double energy = 0;  ///< J
  double slope = 0;   ///< f . n, N: minus dE/dd0
};

EnergyAtOffset energy_at(LocalModel& model, const Vec3& x, double offset) noexcept {
  model.set_offset(offset);
  const LocalResponse r = model.respond(model.deflection(x));
  return {r.energy, dot(r.force, model.normal())};
}

}  // namespace

double least_offset(const LocalModel& model, const Vec3& x, double budget, double low,
                    double high) noexcept {
  LocalModel trial = model;
  EnergyAtOffset at_low = energy_at(trial, x, low);
  if (at_low.energy <= budget) return low;
  for (int i = 0; i < kMostIterations && low < high; ++i) {
    // The energy is convex in the offset, so a Newton step from the side of excess never passes the
    // root; a hair more than the step ends on the side that is allowed.
    double next = low + (1.0 + 1e-7) * (at_low.energy - budget) / at_low.slope;
    if (!(next > low && next < high)) next = low + (high - low) / 2;
    if (next <= low || next >= high) break;
    const EnergyAtOffset at_next = energy_at(trial, x, next);
    if (at_next.energy > budget) {
      low = next;
      at_low = at_next;
      continue;
    }
    high = next;
    if (at_next.energy >= budget * (1.0 - kRelativeEquality)) break;
  }
  return high;
}

void EnergyTank::settle(double energy_before, double energy_after) noexcept {
  level_ = std::clamp(level_ + energy_before - energy_after, 0.0, cap_);
}

EnergyVerdict judge(const LocalModel& moved, const Vec3& x, const LocalResponse& at, double budget,
                    double goal, double recovery) noexcept {
  const double offset = moved.offset();
  if (at.energy > budget) {
    LocalModel trial = moved;
    const double relaxed = std::max(offset, moved.deflection(x).geometric);
    if (energy_at(trial, x, relaxed).energy > budget) return {true, true, offset};
    return {false, true, least_offset(moved, x, budget, offset, relaxed)};
  }
  const double lowest = std::max(goal, offset - recovery);
  if (lowest >= offset) return {false, false, offset};
  return {false, false, least_offset(moved, x, budget, lowest, offset)};
}

}  // namespace palpate::runtime
