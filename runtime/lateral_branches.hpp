// SPDX-License-Identifier: Apache-2.0
// The lateral memories of a contact with tissue that relaxes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/library.hpp"
#include "format/vec3.hpp"
#include "runtime/interpolated_response.hpp"
#include "runtime/kept_pieces.hpp"
#include "runtime/lanes.hpp"
#include "runtime/tissue_memory.hpp"

namespace palpate::runtime {

/// Where lateral memories come to lie: a response, its fractions g_i, and the normal there.
struct LateralPlace {
  const InterpolatedResponse* response;
  const Lanes* fractions;
  Vec3 normal;
};

/// One lateral deflection p_i (m) for each relaxation time, tangential to the surface: M_i =
/// grad H(p_i) is the force that the branch has relaxed. A deflection is kept rather than its force
/// since every response has a force for it. Every function is noexcept, allocation-free and
/// bounded. For decoupled responses.
class LateralBranches {
 public:
  explicit LateralBranches(std::size_t count) noexcept : pieces_(count, ResponseOf::Lateral) {}

  /// M and K where the memories lie.
  const LateralMemory& now() const noexcept { return now_; }
  /// The same at another place: every deflection turns with the normal and is multiplied by
  /// `factor`.
  LateralMemory carried_to(const LateralPlace& place, double factor) const noexcept;
  /// Brings them there, where carried_to() has found `carried`; none: they are forgotten.
  void carry(const LateralPlace& place, const LateralMemory& carried) noexcept;
  /// Time passes while the instantaneous force is `target` (N) at a deflection of `lateral` (m):
  /// M_i := target + (M_i - target) decay_i. V falls. K is 0 until settle().
  void pass(const LateralPlace& place, const Vec3& target, double lateral,
            const Lanes& decay) noexcept;
  /// Finds the deflections, and returns K, J, after a time has passed. now() stays as it is.
  double find_stored(const LateralPlace& place) noexcept;
  /// Gives now() this K, which has been found. Before a slide where time has passed.
  void settle(double stored) noexcept;
  void forget() noexcept { now_ = {}; }

 private:
  /// Two branches at one place.
  struct BranchPair {
    ReachedForces at;  ///< |p_i|, m, with |M_i|, N, and the energies there
    Pair force[3]{};   ///< M_i, N; p_i has its direction
    Pair longest{};    ///< m, that |p_i| may have: no force is beyond those that it is between
  };
  using Branches = std::array<BranchPair, pairs_of(kMaxRelaxationTimes)>;
  bool stays_tangential(const Vec3& normal) const noexcept;
  LateralMemory move(const LateralPlace& place, double factor) const noexcept;

  /// Where the memories lie, and at the end of the slide that was considered last.
  mutable std::array<Branches, 2> branches_{};
  std::size_t here_ = 0;  ///< which of the two are where they lie
  Vec3 normal_{};         ///< to which they are tangential
  LateralMemory now_;
  mutable BranchPieces pieces_;       ///< results do not depend on them
  mutable std::uint64_t slides_ = 0;  ///< how many were
};

}  // namespace palpate::runtime
