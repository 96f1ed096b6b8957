// SPDX-License-Identifier: Apache-2.0
#include "runtime/lateral_branches.hpp"

#include <algorithm>

namespace palpate::runtime {
namespace {

/// M of branches.
class LateralSums {
 public:
  void add(const Pair& fraction, const Pair (&force)[3]) noexcept {
    x_ += fraction * force[0];
    y_ += fraction * force[1];
    z_ += fraction * force[2];
  }
  LateralMemory memory(double stored, double carried, std::uint64_t slide) const noexcept {
    return {Pair{x_[0] + x_[1], y_[0] + y_[1]}, Pair{z_[0] + z_[1], 0}, Pair{stored, carried}, true,
            slide};
  }

 private:
  Pair x_{}, y_{}, z_{};
};

}  // namespace

/// Where the normal turns by more than a right angle it is other tissue.
bool LateralBranches::stays_tangential(const Vec3& normal) const noexcept {
  return dot(normal_, normal) > 0;
}

/// Moves the branches to another place and returns M and K there. Their directions turn by the
/// smallest rotation that takes one normal to the other.
LateralMemory LateralBranches::move(const LateralPlace& place, double factor) const noexcept {
  const Vec3& to = place.normal;
  const Vec3 axis = (1 / (1 + dot(normal_, to))) * (normal_ + to);
  LateralSums sums;
  Pair stored{};
  const Branches& branches = branches_[here_];
  Branches& moved = branches_[1 - here_];
  pieces_.keep_for(*place.response);
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    const BranchPair& from = branches[p];
    BranchPair& there = moved[p];
    const Pair along = from.force[0] * to[0] + from.force[1] * to[1] + from.force[2] * to[2];
    there.at = pieces_.evaluate(p, factor * from.at.deflection);
    there.longest = there.at.deflection;
    const Pair scale = from.at.force > Pair{} ? there.at.force / from.at.force : Pair{};
    for (std::size_t k = 0; k < 3; ++k) there.force[k] = scale * (from.force[k] - along * axis[k]);
    sums.add(place.fractions->pair[p], there.force);
    stored += place.fractions->pair[p] * there.at.conjugate(there.at.force);
  }
  return sums.memory(stored[0] + stored[1], factor, slides_);
}

LateralMemory LateralBranches::carried_to(const LateralPlace& place, double factor) const noexcept {
  if (!now_.any || !stays_tangential(place.normal)) return {};
  ++slides_;
  return move(place, factor);
}

void LateralBranches::carry(const LateralPlace& place, const LateralMemory& carried) noexcept {
  if (carried.any && carried.slide == 0) return;
  now_ = carried;
  now_.slide = 0;
  now_.stored_and_carried = Pair{carried.stored(), 1};
  if (!carried.any) return;
  if (carried.slide != slides_) move(place, carried.carried());
  here_ = 1 - here_;
  normal_ = place.normal;
}

void LateralBranches::pass(const LateralPlace& place, const Vec3& target, double lateral,
                           const Lanes& decay) noexcept {
  if (!now_.any) {
    if (!(lateral > 0)) return;
    branches_[here_] = {};
  }
  normal_ = place.normal;
  LateralSums sums;
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    BranchPair& branch = branches_[here_][p];
    Pair(&force)[3] = branch.force;
    for (std::size_t k = 0; k < 3; ++k)
      force[k] = target[k] + decay.pair[p] * (force[k] - target[k]);
    // The force is between two that were reached, so that its deflection is no longer than theirs.
    branch.longest = larger(branch.longest, both(lateral));
    sums.add(place.fractions->pair[p], force);
  }
  now_ = sums.memory(0, 1, 0);
}

double LateralBranches::find_stored(const LateralPlace& place) noexcept {
  if (!now_.any) return 0;
  Pair stored{};
  pieces_.keep_for(*place.response);
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    BranchPair& branch = branches_[here_][p];
    const Pair(&force)[3] = branch.force;
    const Pair magnitude = roots(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
    branch.at = pieces_.reach(p, magnitude);
    if (!all(at_most(branch.at.deflection, branch.longest)))
      branch.at = pieces_.evaluate(p, smaller(branch.at.deflection, branch.longest));
    stored += place.fractions->pair[p] * branch.at.conjugate(branch.at.force);
  }
  return stored[0] + stored[1];
}

void LateralBranches::settle(double stored) noexcept {
  now_.stored_and_carried = Pair{stored, 1};
}

}  // namespace palpate::runtime
