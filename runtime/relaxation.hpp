// SPDX-License-Identifier: Apache-2.0
// The memories of a contact with tissue that relaxes.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "format/library.hpp"
#include "runtime/interpolated_response.hpp"
#include "runtime/normal_memory.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// One memory F_i (N) for each relaxation time of the library: the quasi-linear viscoelastic law of
/// Fung as Maxwell elements whose energy is convex, theory-runtime (R17)-(R21). They start at 0 and
/// belong to the tissue under the contact point: a slide takes them along and loses them over the
/// length of the tool's radius. Every function is noexcept, allocation-free and bounded. One object
/// belongs to one thread at a time.
class Relaxation {
 public:
  explicit Relaxation(const Surface& surface) noexcept : surface_(&surface) {}

  /// Whether the responses of the surface relax at all.
  bool relaxes() const noexcept { return !surface_->relaxation_times().empty(); }
  /// Whether a memory is above zero.
  bool remembers() const noexcept { return now_.relaxed > 0; }
  /// F, K and R at the contact point.
  const NormalMemory& now() const noexcept { return now_; }
  /// The same after a slide of the contact point to p with this response, `distance` (m) away:
  /// every memory is multiplied by exp(-distance/radius), or by less where R would rise at p.
  NormalMemory carried_to(const SurfacePoint& p, const InterpolatedResponse& response,
                          double distance) const noexcept;
  /// Makes that slide.
  void carry(const SurfacePoint& p, const InterpolatedResponse& response,
             const NormalMemory& carried) noexcept;
  /// A time dt (s) while the instantaneous force at the tool is g (N):
  /// F_i := g* + (F_i - g*) exp(-dt/tau_i), where g* is g, or F where the skin lags behind the
  /// tool. The energy at the tool falls.
  void pass(double g, double dt) noexcept;
  /// The tissue is as new.
  void forget() noexcept;

 private:
  using Branches = std::array<double, kMaxRelaxationTimes>;
  NormalMemory sums(const InterpolatedResponse& response, const Branches& fractions,
                    double factor) const noexcept;
  void keep_decay(double dt) noexcept;

  const Surface* surface_;
  std::optional<InterpolatedResponse> response_;  ///< at the contact point; none before the first
  Branches memory_{};                             ///< F_i, N
  Branches fractions_{};                          ///< g_i at the contact point
  Branches decay_{};                              ///< exp(-dt/tau_i)
  double decay_dt_ = -1;                          ///< s, the dt of decay_
  NormalMemory now_;
  /// Depths at which g was F_i, and F, m: where the next search begins; results do not depend on
  /// them.
  mutable Branches depth_{};
  mutable double skin_ = 0;
};

}  // namespace palpate::runtime
