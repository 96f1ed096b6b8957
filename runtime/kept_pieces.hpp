// SPDX-License-Identifier: Apache-2.0
// The responses of three nodes at the deflections of all relaxation times at once.
#pragma once

#include <array>
#include <cstddef>

#include "format/numbers.hpp"
#include "format/vec3.hpp"
#include "runtime/interpolated_response.hpp"
#include "runtime/lanes.hpp"

namespace palpate::runtime {

/// Deflections, with the forces and the energies of a response there.
struct ReachedForces {
  Lanes deflection;  ///< m; infinity: the response never reaches the force
  Lanes force;       ///< N
  Lanes energy;      ///< J

  /// F d - E of a pair, J: the conjugate energies of these forces; infinity where they are not
  /// reached.
  Pair conjugate(const Pair& of_forces, std::size_t p) const noexcept {
    const Pair& d = deflection.pair[p];
    return d < both(kInfinity) ? of_forces * d - energy.pair[p] : both(kInfinity);
  }
};

/// The piece of one kind of response around the deflection of each lane, from one evaluation to the
/// next: what relaxes moves little in a step. On its piece a response is the quadratic
///   force + slope x + curvature x^2,   x = d - from,
/// and each node has its own, of which a move of the point changes the weights only. Results do not
/// depend on the pieces that were kept. noexcept, allocation-free, bounded by the number of knots.
template <CurveView (NodeCurves::*kCurve)() const noexcept>
class KeptPieces {
 public:
  explicit KeptPieces(std::size_t lanes) noexcept : pairs_(pairs_of(lanes)) {}

  /// The smallest deflections >= 0 at which the response has these forces, in closed form, with the
  /// force and the energy there; all 0 for a force <= 0. Of the lanes in use.
  void reach(const InterpolatedResponse& response, const Lanes& forces, ReachedForces& at) noexcept;
  /// Force and energy at these deflections; all 0 for one <= 0. Of the lanes in use.
  void evaluate(const InterpolatedResponse& response, const Lanes& deflections,
                ReachedForces& at) noexcept;

  std::size_t pairs() const noexcept { return pairs_; }

 private:
  /// Two responses from the starts of their pieces on.
  struct Start {
    Pair force{}, slope{}, curvature{}, energy{};
  };
  struct PiecePair {
    Pair from{}, to{};  ///< m, where the pieces of all three nodes are in use
    Pair end_force{};   ///< N, at `to`; infinity where the piece has no end
    Start merged;
    std::array<Start, 3> nodes;
  };

  void keep_for(const InterpolatedResponse& response) noexcept;
  void find_all(const InterpolatedResponse& response) noexcept;
  template <typename Knots>
  void keep(std::size_t lane, const Knots& knots) noexcept;
  void merge(PiecePair& pieces) const noexcept;

  std::size_t pairs_;
  std::array<const NodeCurves*, 3> nodes_{};  ///< owners of the pieces; null: none
  Vec3 natural_{};                            ///< natural coordinates of what is merged
  std::array<PiecePair, Lanes::kPairs> pieces_;
};

using NormalPieces = KeptPieces<&NodeCurves::normal>;
using LateralPieces = KeptPieces<&NodeCurves::lateral>;

}  // namespace palpate::runtime
