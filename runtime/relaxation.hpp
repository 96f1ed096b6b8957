// SPDX-License-Identifier: Apache-2.0
// The memories of a contact with tissue that relaxes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "runtime/contact_place.hpp"
#include "runtime/interpolated_response.hpp"
#include "runtime/kept_pieces.hpp"
#include "runtime/lanes.hpp"
#include "runtime/lateral_branches.hpp"
#include "runtime/surface.hpp"
#include "runtime/tissue_memory.hpp"

namespace palpate::runtime {

/// Whether the tool still shears the tissue: where it has no normal contact, the tissue has no
/// lateral memory.
enum class Shear : std::uint8_t { Kept, Lost };

/// Two memories for each relaxation time of the library, F_i (N) of the normal and M_i (N,
/// tangential) of the lateral response: the quasi-linear viscoelastic law of Fung as Maxwell
/// elements whose energy is convex, theory-runtime (R17)-(R27). They start at 0 and belong to the
/// tissue under the contact point: a slide takes them along and loses them over the length of the
/// tool's radius. Every function is noexcept, allocation-free and bounded. One object belongs to
/// one thread at a time.
class Relaxation {
 public:
  explicit Relaxation(const Surface& surface) noexcept
      : surface_(&surface),
        times_(surface.relaxation_times().size()),
        lateral_(times_),
        pieces_(times_ + 1, ResponseOf::Depth) {}

  /// Whether the responses of the surface relax at all.
  bool relaxes() const noexcept { return times_ > 0; }
  /// Whether a normal memory is above zero.
  bool remembers() const noexcept { return now_.relaxed() > 0; }
  /// The memory at the contact point.
  TissueMemory now() const noexcept { return {now_, lateral_.now()}; }
  /// R of the normal response, J: what is stored without a tool.
  double locked() const noexcept { return now_.locked(); }
  /// The same after a slide of the contact point to a place `distance` (m) away: every memory is
  /// multiplied by exp(-distance/radius), normal ones by less where R would rise there.
  TissueMemory carried_to(const ContactPlace& place, double distance, Shear shear) const noexcept;
  /// A lateral memory at a place, now() or the last of carried_to(), where the contact there has
  /// grown to hold the tissue with the weights of the place: no M_i changes.
  LateralMemory held_at(const ContactPlace& place, const LateralMemory& memory) const noexcept;
  /// Makes that slide, and takes that grip. slid: the weights at the place before the grip.
  void carry(const ContactPlace& place, const TissueMemory& changed, const Vec3& slid) noexcept;
  /// A time dt (s) while the instantaneous normal force at the tool is g (N):
  /// F_i := g* + (F_i - g*) exp(-dt/tau_i), where g* is g, or F where the skin lags behind the
  /// tool. The energy at the tool falls. Forces are known at once; settle() adds the energies,
  /// which are 0 until then.
  void pass(double g, double dt) noexcept;
  /// The same time for the lateral response, whose instantaneous force at the deflection `lateral`
  /// (m) is `force` (N): M_i := force + (M_i - force) exp(-dt/tau_i).
  void pass_lateral(const Vec3& force, double lateral) noexcept;
  /// What both memories store, J: R of the normal response where the skin lags, K otherwise, and K
  /// of the lateral response. now() stays as it is.
  double find_stored(bool lags) noexcept;
  /// The part of find_stored() for the normal response, for when the processor has time for it.
  void find_normal() noexcept;
  /// Gives now() the energies of both memories. After a time has passed, before a slide.
  void settle() noexcept;
  /// The lateral memories are zero.
  void forget_lateral() noexcept { lateral_.forget(); }
  /// The tissue is as new.
  void forget() noexcept;

 private:
  NormalMemory normal_carried_to(const InterpolatedResponse& response, const Lanes& fractions,
                                 double factor) const noexcept;
  double sum_of_forces(const Lanes& fractions, double factor) const noexcept;
  [[gnu::always_inline]] NormalMemory sums(const InterpolatedResponse& response,
                                           const Lanes& fractions, double factor,
                                           double relaxed) const noexcept;
  void keep_decay(double dt) noexcept;
  void find() noexcept;
  LateralPlace here() const noexcept { return {*response_, fractions_, normal_, weights_}; }

  const Surface* surface_;
  std::size_t times_;                             ///< how many relaxation times
  std::optional<InterpolatedResponse> response_;  ///< at the contact point; none before the first
  Vec3 normal_{};                                 ///< the same
  Vec3 weights_{};                                ///< the same, of the lateral responses
  Lanes memory_{};                                ///< F_i, N
  LateralBranches lateral_;
  Lanes fractions_{};  ///< g_i at the contact point
  Lanes decay_;  ///< exp(-dt/tau_i); that of the last for the next lane, which takes no other path
  double decay_dt_ = -1;  ///< s, the dt of decay_
  NormalMemory now_;
  bool normal_found_ = false, lateral_found_ = false;  ///< the next two, after the last time
  Pair stored_and_locked_{};                           ///< K and R of the normal response, J
  double lateral_stored_ = 0;                          ///< K of the lateral response, J
  mutable SurfacePoint considered_;  ///< the end of the last slide that was considered
  mutable Lanes there_;              ///< g_i there
  mutable BranchPieces pieces_;  ///< at the depths of F_i and of F; results do not depend on them
};

}  // namespace palpate::runtime
