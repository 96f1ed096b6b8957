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
/// Inline but for the search of another piece: a step evaluates a dozen pairs, and a call stores
/// what its caller has in registers.
template <std::size_t kPairs>
class KeptPieces {
 public:
  using Nodes = std::array<const NodeCurves*, 3>;

  /// One kind of response in every lane that is in use.
  KeptPieces(std::size_t lanes, ResponseOf kind) noexcept
      : lanes_(lanes), first_(kind), other_(kind) {}
  /// g in the first lane and h in the second.
  KeptPieces() noexcept : lanes_(2), first_(ResponseOf::Depth), other_(ResponseOf::Lateral) {}

  /// The response of what follows: the nodes, and what each counts in every lane.
  void keep_for(const Nodes& nodes, const Vec3& weights) noexcept {
    const std::uintptr_t others = other_nodes(nodes);
    if ((others | other_weights(0, weights)) != 0) begin(nodes, weights, weights, others != 0);
  }
  /// The same of two kinds in two lanes.
  void keep_for(const Nodes& nodes, const Vec3& first, const Vec3& other) noexcept {
    const std::uintptr_t others = other_nodes(nodes);
    if ((others | other_weights(0, first) | other_weights(1, other)) != 0)
      begin(nodes, first, other, others != 0);
  }

  /// The smallest deflections >= 0 at which the response has the forces of pair p, in closed form;
  /// all 0 for a force <= 0.
  [[gnu::always_inline]] ReachedForces reach(std::size_t p, const Pair& force) noexcept {
    PiecePair& on = pieces_[p];
    const Merged& q = on.merged;
    if (const Pair rise = force - q.force, square = on.square(rise);
        all(less(Pair{}, rise) & at_most(force, on.end_force) & less(Pair{}, square))) {
      const Pair x = smaller(rise / (q.half_slope + roots(square)), on.to - on.from);
      return q.after(x, on.from + x);
    }
    return reach_elsewhere(p, force);
  }
  /// Force and energy at the deflections of pair p; all 0 for one <= 0.
  [[gnu::always_inline]] ReachedForces evaluate(std::size_t p, const Pair& deflection) noexcept {
    PiecePair& on = pieces_[p];
    if (all(less(Pair{}, deflection) & at_most(on.from, deflection) & less(deflection, on.to)))
      return on.merged.after(deflection - on.from, deflection);
    return evaluate_elsewhere(p, deflection);
  }

  std::size_t pairs() const noexcept { return kPairs == 1 ? 1 : pairs_of(lanes_); }

 private:
  /// Two responses of a node at the starts of their pieces.
  struct Start {
    Pair force{}, slope{}, curvature{}, energy{};
  };
  /// Two responses of all three nodes from there on.
  struct Merged {
    Pair force{}, slope{}, half_slope{}, curvature{}, third{},
        energy{};  ///< third: of the curvature

    /// At deflections d, lengths x after the starts.
    ReachedForces after(const Pair& x, const Pair& d) const noexcept {
      const Pair work = x * (force + x * (half_slope + x * third));
      return {d, force + x * (slope + x * curvature), energy + work};
    }
  };
  struct PiecePair {
    Pair from{}, to{};  ///< m, where the pieces of all three nodes are in use
    Pair end_force{};   ///< N, at `to`; infinity where the piece has no end
    Merged merged;
    std::array<Start, 3> nodes;

    /// Square of half the slope where the force has risen.
    Pair square(const Pair& rise) const noexcept {
      return merged.half_slope * merged.half_slope + merged.curvature * rise;
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

  /// Zero where the nodes are those. Without branches: a step asks half a dozen times. The terms
  /// are written one by one: a compiler that reads two at once waits for what was just stored.
  std::uintptr_t other_nodes(const Nodes& nodes) const noexcept {
    const auto apart = [&](std::size_t l) {
      return std::bit_cast<std::uintptr_t>(nodes_[l]) ^ std::bit_cast<std::uintptr_t>(nodes[l]);
    };
    return apart(0) | apart(1) | apart(2);
  }
  /// Zero where the weights in the first lane (0) or in the others (1) are those, bit by bit.
  std::uint64_t other_weights(std::size_t lane, const Vec3& weights) const noexcept {
    const auto apart = [&](std::size_t l) {
      return std::bit_cast<std::uint64_t>(double{weights_[l][lane]}) ^
             std::bit_cast<std::uint64_t>(weights[l]);
    };
    return apart(0) | apart(1) | apart(2);
  }
  Pair mix(const std::array<Start, 3>& nodes, Pair Start::*of) const noexcept {
    return weights_[0] * (nodes[0].*of) + weights_[1] * (nodes[1].*of) +
           weights_[2] * (nodes[2].*of);
  }
  void merge(PiecePair& on) const noexcept {
    const Pair slope = mix(on.nodes, &Start::slope), curvature = mix(on.nodes, &Start::curvature);
    on.merged = {mix(on.nodes, &Start::force), slope, slope / 2.0, curvature, curvature * kThird,
                 mix(on.nodes, &Start::energy)};
    const Pair length = on.to - on.from;
    const Pair end = on.merged.force + length * (on.merged.slope + length * on.merged.curvature);
    on.end_force = length < both(kInfinity) ? end : both(kInfinity);
  }

  /// Not inlined, so that keep_for() is.
  [[gnu::noinline]] void begin(const Nodes& nodes, const Vec3& first, const Vec3& other,
                               bool others) noexcept {
    for (std::size_t l = 0; l < 3; ++l) weights_[l] = Pair{first[l], other[l]};
    if (others) find_all(nodes);
    for (std::size_t p = 0; p < pairs(); ++p) merge(pieces_[p]);
  }
  void find_all(const Nodes& nodes) noexcept;
  ReachedForces reach_elsewhere(std::size_t p, Pair force) noexcept;
  ReachedForces evaluate_elsewhere(std::size_t p, Pair deflection) noexcept;
  void walk(std::size_t p, const Pair& force) noexcept;
  void find(std::size_t p, const Pair& deflection) noexcept;
  template <typename Act>
  void with_knots(std::size_t lane, double at, const Act& act) noexcept;
  template <typename Knots>
  void keep(std::size_t lane, const Knots& knots) noexcept;

  std::size_t lanes_;
  ResponseOf first_, other_;       ///< of the first lane and of the others
  Nodes nodes_{};                  ///< owners of the pieces; null: none
  std::array<Pair, 3> weights_{};  ///< of what is merged: first lane, other lanes
  std::array<PiecePair, kPairs> pieces_;
};

using BranchPieces = KeptPieces<Lanes::kPairs>;  ///< of all relaxation times
using TipPieces = KeptPieces<1>;                 ///< of g and h at the tip

}  // namespace palpate::runtime
