// SPDX-License-Identifier: Apache-2.0
// The responses of three nodes at the deflections of all relaxation times at once.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "format/numbers.hpp"
#include "format/vec3.hpp"
#include "runtime/interpolated_response.hpp"
#include "runtime/lanes.hpp"

namespace palpate::runtime {

/// Two deflections, with the forces and the energies of a response there.
struct ReachedForces {
  Pair deflection{};  ///< m; infinity: the response never reaches the force
  Pair force{};       ///< N
  Pair energy{};      ///< J; minus infinity where the force is not reached

  /// All 0 elsewhere.
  ReachedForces where(const Mask& presses) const noexcept {
    return {presses ? deflection : Pair{}, presses ? force : Pair{}, presses ? energy : Pair{}};
  }
  /// F d - E, J: the conjugate energies of these forces; infinity where they are not reached.
  Pair conjugate(const Pair& of_forces) const noexcept { return of_forces * deflection - energy; }
};

/// g(z) or h(rho).
enum class ResponseOf : std::uint8_t { Depth, Lateral };

/// The piece of a response around the deflection of each lane, from one evaluation to the
/// next: what relaxes moves little in a step. On its piece a response is the quadratic
///   force + slope x + curvature x^2,   x = d - from,
/// and each node has its own, of which a move of the point changes the weights only. Results do not
/// depend on the pieces that were kept. noexcept, allocation-free, bounded by the number of knots.
/// Inline but for the search of another piece: a step evaluates a dozen pairs.
template <std::size_t kPairs>
class KeptPieces {
 public:
  /// One kind of response in every lane that is in use.
  KeptPieces(std::size_t lanes, ResponseOf kind) noexcept
      : lanes_(lanes), first_(kind), other_(kind) {}
  /// g in the first lane and h in the second.
  KeptPieces() noexcept : lanes_(2), first_(ResponseOf::Depth), other_(ResponseOf::Lateral) {}

  /// The response of what follows, with weights of its own for h.
  void keep_for(const InterpolatedResponse& response, const Vec3& lateral) noexcept {
    const std::uintptr_t other_nodes = bits_apart(nodes_, response.nodes());
    const std::uint64_t other_weights =
        bits_apart(natural_, response.natural()) | bits_apart(lateral_, lateral);
    if ((other_nodes | other_weights) != 0) begin(response, lateral, other_nodes != 0);
  }
  void keep_for(const InterpolatedResponse& response) noexcept {
    keep_for(response, response.natural());
  }

  /// The smallest deflections >= 0 at which the response has the forces of pair p, in closed form;
  /// all 0 for a force <= 0.
  ReachedForces reach(std::size_t p, const Pair& force) noexcept {
    PiecePair& on = pieces_[p];
    const Start& q = on.merged;
    if (const Pair rise = force - q.force, square = on.square(rise);
        all(less(Pair{}, rise) & at_most(force, on.end_force) & less(Pair{}, square))) {
      const Pair x = smaller(2.0 * rise / (q.slope + roots(square)), on.to - on.from);
      return q.after(x, on.from + x);
    }
    return reach_elsewhere(p, force);
  }
  /// Force and energy at the deflections of pair p; all 0 for one <= 0.
  ReachedForces evaluate(std::size_t p, const Pair& deflection) noexcept {
    PiecePair& on = pieces_[p];
    if (all(less(Pair{}, deflection) & at_most(on.from, deflection) & less(deflection, on.to)))
      return on.merged.after(deflection - on.from, deflection);
    return evaluate_elsewhere(p, deflection);
  }

  std::size_t pairs() const noexcept { return kPairs == 1 ? 1 : pairs_of(lanes_); }

 private:
  /// Two responses from the starts of their pieces on.
  struct Start {
    Pair force{}, slope{}, curvature{}, energy{};

    /// At deflections d, lengths x after the starts.
    ReachedForces after(const Pair& x, const Pair& d) const noexcept {
      const Pair work = x * (force + x * (slope / 2.0 + x * (curvature * kThird)));
      return {d, force + x * (slope + x * curvature), energy + work};
    }
  };
  struct PiecePair {
    Pair from{}, to{};  ///< m, where the pieces of all three nodes are in use
    Pair end_force{};   ///< N, at `to`; infinity where the piece has no end
    Start merged;
    std::array<Start, 3> nodes;

    /// Square of the slope where the force has risen.
    Pair square(const Pair& rise) const noexcept {
      return merged.slope * merged.slope + 4.0 * merged.curvature * rise;
    }
    /// Do the pieces contain the answers of an inverse? The first that reach the forces do.
    Mask reaches(const Pair& force) const noexcept {
      const Mask begins_below = less(merged.force, force) | at_most(from, Pair{});
      return at_most(force, Pair{}) | (begins_below & at_most(force, end_force));
    }
    Mask contains(const Pair& d) const noexcept {
      return at_most(d, Pair{}) | (at_most(from, d) & less(d, to));
    }
  };

  /// Zero where the bits are the same. Without branches: a step asks half a dozen times.
  static std::uint64_t bits_apart(const Vec3& a, const Vec3& b) noexcept {
    std::uint64_t apart = 0;
    for (std::size_t l = 0; l < 3; ++l)
      apart |= std::bit_cast<std::uint64_t>(a[l]) ^ std::bit_cast<std::uint64_t>(b[l]);
    return apart;
  }
  static std::uintptr_t bits_apart(const std::array<const NodeCurves*, 3>& a,
                                   const std::array<const NodeCurves*, 3>& b) noexcept {
    std::uintptr_t apart = 0;
    for (std::size_t l = 0; l < 3; ++l)
      apart |= std::bit_cast<std::uintptr_t>(a[l]) ^ std::bit_cast<std::uintptr_t>(b[l]);
    return apart;
  }
  Pair mix(const std::array<Start, 3>& nodes, Pair Start::*of) const noexcept {
    return weights_[0] * (nodes[0].*of) + weights_[1] * (nodes[1].*of) +
           weights_[2] * (nodes[2].*of);
  }
  void merge(PiecePair& on) const noexcept {
    on.merged = {mix(on.nodes, &Start::force), mix(on.nodes, &Start::slope),
                 mix(on.nodes, &Start::curvature), mix(on.nodes, &Start::energy)};
    const Pair length = on.to - on.from;
    const Pair end = on.merged.force + length * (on.merged.slope + length * on.merged.curvature);
    on.end_force = length < both(kInfinity) ? end : both(kInfinity);
  }

  /// Not inlined, so that keep_for() is.
  [[gnu::noinline]] void begin(const InterpolatedResponse& response, const Vec3& lateral,
                               bool other_nodes) noexcept {
    natural_ = response.natural();
    lateral_ = lateral;
    const Vec3& first = first_ == ResponseOf::Depth ? natural_ : lateral_;
    const Vec3& other = other_ == ResponseOf::Depth ? natural_ : lateral_;
    for (std::size_t l = 0; l < 3; ++l) weights_[l] = Pair{first[l], other[l]};
    if (other_nodes) find_all(response.nodes());
    for (std::size_t p = 0; p < pairs(); ++p) merge(pieces_[p]);
  }
  void find_all(const std::array<const NodeCurves*, 3>& nodes) noexcept;
  ReachedForces reach_elsewhere(std::size_t p, Pair force) noexcept;
  ReachedForces evaluate_elsewhere(std::size_t p, Pair deflection) noexcept;
  void walk(std::size_t p, const Pair& force) noexcept;
  void find(std::size_t p, const Pair& deflection) noexcept;
  template <typename Act>
  void with_knots(std::size_t lane, double at, const Act& act) noexcept;
  template <typename Knots>
  void keep(std::size_t lane, const Knots& knots) noexcept;

  std::size_t lanes_;
  ResponseOf first_, other_;                  ///< of the first lane and of the others
  std::array<const NodeCurves*, 3> nodes_{};  ///< owners of the pieces; null: none
  Vec3 natural_{}, lateral_{};                ///< weights of what is merged, of g and h
  std::array<Pair, 3> weights_{};             ///< the same: first lane, other lanes
  std::array<PiecePair, kPairs> pieces_;
};

using BranchPieces = KeptPieces<Lanes::kPairs>;  ///< of all relaxation times
using TipPieces = KeptPieces<1>;                 ///< of g and h at the tip

}  // namespace palpate::runtime
