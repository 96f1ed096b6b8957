// SPDX-License-Identifier: Apache-2.0
#include "runtime/lateral_branches.hpp"

#include <algorithm>

namespace palpate::runtime {

/// Where the normal turns by more than a right angle it is other tissue.
bool LateralBranches::stays_tangential(const Vec3& normal) const noexcept {
  return dot(normal_, normal) > 0;
}

/// The branches at another place. Their directions turn by the smallest rotation that takes one
/// normal to the other.
void LateralBranches::move(const LateralPlace& place, double factor,
                           Branches& there) const noexcept {
  const Vec3 axis = (1 / (1 + dot(normal_, place.normal))) * (normal_ + place.normal);
  const Vec3& to = place.normal;
  Lanes deflection;
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    const Pair &x = branches_.direction[0].pair[p], &y = branches_.direction[1].pair[p],
               &z = branches_.direction[2].pair[p];
    const Pair along = x * to[0] + y * to[1] + z * to[2];
    there.direction[0].pair[p] = x - along * axis[0];
    there.direction[1].pair[p] = y - along * axis[1];
    there.direction[2].pair[p] = z - along * axis[2];
    deflection.pair[p] = factor * branches_.at.deflection.pair[p];
  }
  pieces_.evaluate(*place.response, deflection, there.at);
}

/// M and K of branches.
LateralMemory LateralBranches::sums(const Lanes& fractions, const Branches& of) const noexcept {
  Pair x{}, y{}, z{}, stored{};
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    const Pair& g = fractions.pair[p];
    const Pair& force = of.at.force.pair[p];
    const Pair relaxed = g * force;
    x += relaxed * of.direction[0].pair[p];
    y += relaxed * of.direction[1].pair[p];
    z += relaxed * of.direction[2].pair[p];
    stored += g * (force * of.at.deflection.pair[p] - of.at.energy.pair[p]);
  }
  LateralMemory sum;
  sum.any = true;
  sum.relaxed = {x[0] + x[1], y[0] + y[1], z[0] + z[1]};
  sum.stored = stored[0] + stored[1];
  return sum;
}

LateralMemory LateralBranches::carried_to(const LateralPlace& place, double factor) const noexcept {
  if (!now_.any || !stays_tangential(place.normal)) return {};
  move(place, factor, moved_);
  LateralMemory sum = sums(*place.fractions, moved_);
  sum.slide = ++slides_;
  sum.carried = factor;
  return sum;
}

void LateralBranches::carry(const LateralPlace& place, const LateralMemory& carried) noexcept {
  if (carried.any && carried.slide == 0) return;
  now_ = carried;
  now_.slide = 0;
  now_.carried = 1;
  if (!carried.any) return;
  if (carried.slide != slides_) move(place, carried.carried, moved_);
  branches_ = moved_;
  normal_ = place.normal;
}

void LateralBranches::pass(const LateralPlace& place, const Vec3& target, double lateral,
                           const Lanes& decay) noexcept {
  if (!now_.any) {
    if (!(lateral > 0)) return;
    branches_ = {};
  }
  normal_ = place.normal;
  Lanes magnitude;
  ReachedForces& at = branches_.at;
  const Lanes before = at.deflection;
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    Pair square{};
    for (std::size_t k = 0; k < 3; ++k) {
      Pair& direction = branches_.direction[k].pair[p];
      const Pair force = at.force.pair[p] * direction;
      direction = target[k] + decay.pair[p] * (force - target[k]);
      square += direction * direction;
    }
    magnitude.pair[p] = roots(square);
    for (std::size_t k = 0; k < 3; ++k) {
      Pair& direction = branches_.direction[k].pair[p];
      direction = square > Pair{} ? (1 / magnitude.pair[p]) * direction : Pair{};
    }
  }
  pieces_.reach(*place.response, magnitude, at);
  // The force is between two that were reached, so that its deflection is no longer than theirs.
  Lanes no_longer;
  bool longer = false;
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    no_longer.pair[p] = smaller(at.deflection.pair[p], larger(before.pair[p], both(lateral)));
    longer = longer || !all(no_longer.pair[p] >= at.deflection.pair[p]);
  }
  if (longer) pieces_.evaluate(*place.response, no_longer, at);
  now_ = sums(*place.fractions, branches_);
}

}  // namespace palpate::runtime
