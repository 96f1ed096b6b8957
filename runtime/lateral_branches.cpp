// SPDX-License-Identifier: Apache-2.0
#include "runtime/lateral_branches.hpp"

#include <algorithm>

namespace palpate::runtime {
namespace {

/// A vector across one unit vector after the smallest rotation that takes this to another.
Vec3 turned(const Vec3& v, const Vec3& from, const Vec3& to) noexcept {
  return v - (dot(v, to) / (1 + dot(from, to))) * (from + to);
}

/// Adds a branch whose force lies along `direction`, and returns that force M_i.
Vec3 add_branch(LateralMemory& sum, double fraction, const ReachedForce& at,
                const Vec3& direction) noexcept {
  const Vec3 force = at.force * direction;
  sum.relaxed = sum.relaxed + fraction * force;
  sum.stored += fraction * at.conjugate(at.force);
  return force;
}

}  // namespace

/// Where the normal turns by more than a right angle it is other tissue.
bool LateralBranches::stays_tangential(const Vec3& normal) const noexcept {
  return dot(normal_, normal) > 0;
}

LateralMemory LateralBranches::carried_to(const LateralPlace& place, double factor) const noexcept {
  if (!now_.any || !stays_tangential(place.normal)) return {};
  LateralMemory sum;
  sum.any = sum.moved = true;
  sum.carried = factor;
  for (std::size_t i = 0; i < count_; ++i) {
    const Branch& branch = branches_[i];
    if (!(branch.reach > 0)) continue;
    const Vec3 direction = (1 / branch.reach) * turned(branch.deflection, normal_, place.normal);
    const double reach = factor * branch.reach;
    add_branch(sum, (*place.fractions)[i], place.response->lateral_at(reach, branch.piece),
               direction);
  }
  return sum;
}

void LateralBranches::carry(const LateralPlace& place, const LateralMemory& carried) noexcept {
  if (carried.any && !carried.moved) return;
  now_ = carried;
  now_.moved = false;
  now_.carried = 1;
  if (!carried.any) return;
  for (std::size_t i = 0; i < count_; ++i) {
    Branch& branch = branches_[i];
    if (!(branch.reach > 0)) continue;
    const Vec3 direction = (1 / branch.reach) * turned(branch.deflection, normal_, place.normal);
    branch.reach *= carried.carried;
    branch.deflection = branch.reach * direction;
    branch.force = place.response->lateral_at(branch.reach, branch.piece).force * direction;
  }
  normal_ = place.normal;
}

void LateralBranches::pass(const LateralPlace& place, const Vec3& target, double lateral,
                           const Branches& decay) noexcept {
  if (!now_.any) {
    if (!(lateral > 0)) return;
    branches_ = {};
  }
  normal_ = place.normal;
  now_ = {};
  now_.any = true;
  for (std::size_t i = 0; i < count_; ++i) {
    Branch& branch = branches_[i];
    const Vec3 force = target + decay[i] * (branch.force - target);
    const double magnitude = norm(force);
    // The force is between two that were reached, so that its deflection is no longer than theirs.
    const double longest = std::max(branch.reach, lateral);
    ReachedForce at = place.response->lateral_reach(magnitude, branch.piece);
    if (at.deflection > longest) at = place.response->lateral_at(longest, branch.piece);
    branch.reach = at.deflection;
    const Vec3 direction = magnitude > 0 ? (1 / magnitude) * force : Vec3{};
    branch.deflection = branch.reach * direction;
    branch.force = add_branch(now_, (*place.fractions)[i], at, direction);
  }
}

}  // namespace palpate::runtime
