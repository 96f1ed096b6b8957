// SPDX-License-Identifier: Apache-2.0
// The memories of a contact with tissue that relaxes.
#pragma once

#include <array>
#include <cstddef>

#include "format/library.hpp"
#include "runtime/normal_memory.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// One memory a_i for each relaxation time of the library: linear Maxwell elements in the
/// coordinate y of the normal response, theory-runtime (R17)-(R21). They start at 0 and belong to
/// the tissue under the contact point: a slide takes them along and loses them over the length of
/// the tool's radius. Every function is noexcept, allocation-free and bounded. One object belongs
/// to one thread at a time.
class Relaxation {
 public:
  explicit Relaxation(const Surface& surface) noexcept : surface_(&surface) {}

  /// Whether the responses of the surface relax at all.
  bool relaxes() const noexcept { return !surface_->relaxation_times().empty(); }
  /// Whether a memory is above zero.
  bool remembers() const noexcept { return now_.relaxed > 0; }
  /// A and R at the contact point.
  const NormalMemory& now() const noexcept { return now_; }
  /// The same after a slide of the contact point to p, `distance` (m) away: every memory is
  /// multiplied by exp(-distance/radius), or by less where the fractions at p would raise R.
  NormalMemory carried_to(const SurfacePoint& p, double distance) const noexcept;
  /// Makes that slide.
  void carry(const SurfacePoint& p, const NormalMemory& carried) noexcept;
  /// A time dt (s) at the coordinate y of the tool: a_i := y* + (a_i - y*) exp(-dt/tau_i), where y*
  /// is y, or A where the skin lags behind the tool. g_inf y*^2/2 + sum g_i (y* - a_i)^2/2 falls.
  void pass(double y, double dt) noexcept;
  /// The tissue is as new.
  void forget() noexcept;

 private:
  using Branches = std::array<double, kMaxRelaxationTimes>;
  NormalMemory sums(const Branches& fractions) const noexcept;
  void keep_decay(double dt) noexcept;

  const Surface* surface_;
  Branches memory_{};     ///< a_i, sqrt(J)
  Branches fractions_{};  ///< g_i at the contact point
  Branches decay_{};      ///< exp(-dt/tau_i)
  double decay_dt_ = -1;  ///< s, the dt of decay_
  NormalMemory now_;
};

}  // namespace palpate::runtime
