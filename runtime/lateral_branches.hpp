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

/// Where lateral memories come to lie: a response, its fractions g_i, and the normal there. A view.
struct LateralPlace {
  const InterpolatedResponse& response;
  const Lanes& fractions;
  const Vec3& normal;
  const Vec3&
      weights;  ///< of the three lateral responses: n_l, or n_l w_l of the grip when coupled
};

/// One lateral deflection p_i (m) for each relaxation time, tangential to the surface: M_i =
/// grad H(p_i) is the force that the branch has relaxed. A deflection is kept rather than its force
/// since every response has a force for it. Every function is noexcept, allocation-free and
/// bounded.
class LateralBranches {
 public:
  explicit LateralBranches(std::size_t count) noexcept : pieces_(count, ResponseOf::Lateral) {}

  /// M and K where the memories lie.
  const LateralMemory& now() const noexcept { return now_; }
  /// The same at another place: every deflection turns with the normal and is multiplied by
  /// `factor`.
  LateralMemory carried_to(const LateralPlace& place, double factor) const noexcept;
  /// A memory that began as now() or the last of carried_to(), and of which a contact that has
  /// shrunk may have left a part, where the contact grows to hold the tissue with the weights of
  /// the place: no M_i changes.
  LateralMemory held_at(const LateralPlace& place, const LateralMemory& memory) const noexcept;
  /// Brings them there, and to what is left of their forces, where carried_to() and held_at() have
  /// found `changed`; none: they are forgotten. slid: the weights at the place before those of a
  /// contact that has grown.
  void carry(const LateralPlace& place, const LateralMemory& changed, const Vec3& slid) noexcept;
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
  LateralMemory hold(const LateralPlace& place, const Branches& from, double scale) const noexcept;
  void shrink(double scale) noexcept;
  [[gnu::always_inline]] void reach(std::size_t p, BranchPair& branch) const noexcept;
  void repeat(const LateralPlace& place, const LateralMemory& changed, const Vec3& slid) noexcept;

  /// Where the memories lie, at the end of the slide that was considered last, and with the grip
  /// that was.
  mutable std::array<Branches, 3> branches_{};
  std::size_t here_ = 0, slid_ = 1, held_ = 2;  ///< which of the three are these
  Vec3 normal_{};                               ///< to which they are tangential
  LateralMemory now_;
  mutable BranchPieces pieces_;  ///< results do not depend on them
  /// How many slides and grips were considered, and the last of each that is at hand.
  mutable std::uint64_t considered_ = 0, last_slide_ = 0, last_grip_ = 0;
};

}  // namespace palpate::runtime
