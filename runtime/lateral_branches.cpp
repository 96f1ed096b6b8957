// SPDX-License-Identifier: Apache-2.0
#include "runtime/lateral_branches.hpp"

#include <algorithm>
#include <utility>

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
  LateralMemory memory(double stored) const noexcept {
    LateralMemory sum;
    sum.relaxed_xy = Pair{x_[0] + x_[1], y_[0] + y_[1]};
    sum.relaxed_z = Pair{z_[0] + z_[1], 0};
    sum.stored_and_carried = Pair{stored, 1};
    sum.any = true;
    return sum;
  }

 private:
  Pair x_{}, y_{}, z_{};
};

}  // namespace

/// Where the normal turns by more than a right angle it is other tissue.
bool LateralBranches::stays_tangential(const Vec3& normal) const noexcept {
  return dot(normal_, normal) > 0;
}

/// Finds where the forces of two branches are reached.
inline void LateralBranches::reach(std::size_t p, BranchPair& branch) const noexcept {
  const Pair(&force)[3] = branch.force;
  const Pair magnitude = roots(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
  branch.at = pieces_.reach(p, magnitude);
  if (!all(at_most(branch.at.deflection, branch.longest)))  // by rounding
    branch.at = pieces_.evaluate(p, smaller(branch.at.deflection, branch.longest));
}

/// Moves the branches to another place and returns M and K there. Their directions turn by the
/// smallest rotation that takes one normal to the other.
LateralMemory LateralBranches::move(const LateralPlace& place, double factor) const noexcept {
  const Vec3& to = place.normal;
  const Vec3 axis = (1 / (1 + dot(normal_, to))) * (normal_ + to);
  LateralSums sums;
  Pair stored{};
  const Branches& branches = branches_[here_];
  Branches& moved = branches_[slid_];
  pieces_.keep_for(place.response.nodes(), place.weights);
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    const BranchPair& from = branches[p];
    BranchPair& there = moved[p];
    const Pair along = from.force[0] * to[0] + from.force[1] * to[1] + from.force[2] * to[2];
    there.at = pieces_.evaluate(p, factor * from.at.deflection);
    there.longest = there.at.deflection;
    const Pair scale = from.at.force > Pair{} ? there.at.force / from.at.force : Pair{};
    for (std::size_t k = 0; k < 3; ++k) there.force[k] = scale * (from.force[k] - along * axis[k]);
    sums.add(place.fractions.pair[p], there.force);
    stored += place.fractions.pair[p] * there.at.conjugate(there.at.force);
  }
  return sums.memory(stored[0] + stored[1]);
}

/// Multiplies the forces, and finds where they are reached with the weights of the place, which
/// are no smaller than those before times the same.
LateralMemory LateralBranches::hold(const LateralPlace& place, const Branches& from,
                                    double scale) const noexcept {
  LateralSums sums;
  Pair stored{};
  Branches& held = branches_[held_];
  pieces_.keep_for(place.response.nodes(), place.weights);
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    BranchPair& there = held[p];
    for (std::size_t k = 0; k < 3; ++k) there.force[k] = scale * from[p].force[k];
    there.longest = from[p].longest;
    reach(p, there);
    there.longest = there.at.deflection;
    sums.add(place.fractions.pair[p], there.force);
    stored += place.fractions.pair[p] * there.at.conjugate(there.at.force);
  }
  return sums.memory(stored[0] + stored[1]);
}

LateralMemory LateralBranches::carried_to(const LateralPlace& place, double factor) const noexcept {
  if (!now_.any || !stays_tangential(place.normal)) return {};
  LateralMemory there = move(place, factor);
  there.stored_and_carried = Pair{there.stored(), factor};
  there.slide = last_slide_ = ++considered_;
  return there;
}

LateralMemory LateralBranches::held_at(const LateralPlace& place,
                                       const LateralMemory& memory) const noexcept {
  if (!memory.any) return {};
  LateralMemory there = hold(place, branches_[memory.slide != 0 ? slid_ : here_], memory.held);
  there.stored_and_carried = Pair{there.stored(), memory.carried()};
  there.held = memory.held;
  there.slide = memory.slide;
  there.grip = last_grip_ = ++considered_;
  return there;
}

void LateralBranches::carry(const LateralPlace& place, const LateralMemory& changed,
                            const Vec3& slid) noexcept {
  if (changed.any) {
    const bool moves = changed.slide != 0, grows = changed.grip != 0;
    // Others may have been considered since.
    if (grows ? changed.grip != last_grip_ : moves && changed.slide != last_slide_)
      repeat(place, changed, slid);
    if (grows)
      std::swap(here_, held_);
    else if (moves)
      std::swap(here_, slid_);
    if (!grows && changed.held != 1) shrink(changed.held);
    last_slide_ = last_grip_ = 0;
    normal_ = place.normal;
  }
  now_ = changed;
  now_.stored_and_carried = Pair{changed.stored(), 1};
  now_.held = 1;
  now_.slide = now_.grip = 0;
}

/// What a contact that shrinks leaves of the forces; the deflections stay.
void LateralBranches::shrink(double scale) noexcept {
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    BranchPair& branch = branches_[here_][p];
    for (Pair& force : branch.force) force *= scale;
    branch.at.force *= scale;
    branch.at.energy *= scale;
  }
}

/// Considers a slide and a grip once more.
void LateralBranches::repeat(const LateralPlace& place, const LateralMemory& changed,
                             const Vec3& slid) noexcept {
  const bool moves = changed.slide != 0;
  if (moves) {
    const bool grows = changed.grip != 0;
    move({place.response, place.fractions, place.normal, grows ? slid : place.weights},
         changed.carried());
  }
  if (changed.grip != 0) hold(place, branches_[moves ? slid_ : here_], changed.held);
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
    sums.add(place.fractions.pair[p], force);
  }
  now_ = sums.memory(0);
}

double LateralBranches::find_stored(const LateralPlace& place) noexcept {
  if (!now_.any) return 0;
  Pair stored{};
  pieces_.keep_for(place.response.nodes(), place.weights);
  for (std::size_t p = 0; p < pieces_.pairs(); ++p) {
    BranchPair& branch = branches_[here_][p];
    reach(p, branch);
    stored += place.fractions.pair[p] * branch.at.conjugate(branch.at.force);
  }
  return stored[0] + stored[1];
}

void LateralBranches::settle(double stored) noexcept {
  now_.stored_and_carried = Pair{stored, 1};
}

}  // namespace palpate::runtime
