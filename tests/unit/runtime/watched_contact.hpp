// SPDX-License-Identifier: AGPL-3.0-or-later
// A contact under observation: every step is held to passivity, continuity and finiteness.
#pragma once

#include <cstdint>

#include "format/library.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/handles.hpp"

namespace palpate::test {

/// Energy of the local model that an observation describes, with the tip at x, J: the stored slopes
/// integrated twice here, knot by knot, without the runtime's own evaluation.
double model_energy(const Library& library, const runtime::ContactObservation& model,
                    const Vec3& x);

/// Steps a contact and keeps what the worst step did. The account is computed with model_energy.
class WatchedContact {
 public:
  WatchedContact(const Library& library, const palpate_library& body,
                 const runtime::ContactSettings& settings);

  std::uint32_t step(const Vec3& x);
  void set_delivery(const runtime::Delivery* delivered) { contact_.set_delivery(delivered); }

  const runtime::ContactObservation& seen() const { return contact_.observation(); }
  double work() const { return work_; }  ///< net work of the tool on the body since the start, J

  long steps = 0, contacts = 0, slides = 0, limited = 0, force_limited = 0, drops = 0;
  bool always_finite = true;
  double lowest = 0;                ///< J, least of work()
  double largest_gain = 0;          ///< J, of tank + E at an activation: passive means none
  double largest_disagreement = 0;  ///< J, runtime's account against work()
  /// Largest |f_i(x_i) - f_{i-1}(x_{i-1})| over steepness |x_i - x_{i-1}|, of the steps that did
  /// not report a drop. Of coupled responses those that friction held: beyond the slip limit, at a
  /// border or while a slide is held back, they are steeper.
  double steepest_step = 0;
  /// Of coupled responses, all such steps, over the larger of the steepness and of what the stored
  /// curves allow a held contact point at that lateral deflection.
  double steepest_beyond = 0;
  long stuck = 0;  ///< steps of coupled responses that friction held

 private:
  void account(const Vec3& x, const runtime::ContactObservation& before);
  void compare(const Vec3& x, const runtime::ContactObservation& before);
  bool sticks(const runtime::ContactObservation& model, double depth, double rho) const;

  const Library& library_;
  runtime::ContactState contact_;
  double bound_ = 0;  ///< N/m
  double friction_ = 0;
  Vec3 last_{};
  double work_ = 0;
};

}  // namespace palpate::test
