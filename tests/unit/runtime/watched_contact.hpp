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

  long steps = 0, contacts = 0, slides = 0, limited = 0, force_limited = 0;
  long cuts = 0;  ///< contacts dropped although the input was good
  bool always_finite = true;
  double lowest = 0;        ///< J, least of work()
  double largest_gain = 0;  ///< J, of tank + E at an activation: passive means none
  /// J, runtime's account against work(); of more than a joule, the relative difference.
  double largest_disagreement = 0;
  /// Largest |f_i(x_i) - f_{i-1}(x_{i-1})| over Lipschitz bound |x_i - x_{i-1}|, of the steps with
  /// good input.
  double steepest_step = 0;
  /// Largest excess of the lateral force over mu g; of decoupled responses over what one step of
  /// travel can give, (1 + mu) Lipschitz bound times the longest of the contact, of coupled ones
  /// over nothing but rounding.
  double largest_overdraft = 0;
  long apart = 0;  ///< steps in which the lateral offset was not zero

 private:
  void account(const Vec3& x, const runtime::ContactObservation& before);
  void compare(const Vec3& x, const runtime::ContactObservation& before);
  double overdraft(const runtime::ContactObservation& model) const;

  const Library& library_;
  runtime::ContactState contact_;
  double bound_ = 0;  ///< N/m
  double friction_ = 0;
  double longest_ = 0;  ///< m, step of the contact
  Vec3 last_{};
  double work_ = 0;
};

}  // namespace palpate::test
