// SPDX-License-Identifier: AGPL-3.0-or-later
// A contact under observation: every step is held to passivity, continuity and finiteness.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "format/library.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/handles.hpp"

namespace palpate::test {

/// The local model that an observation describes, with the tip at x, for tissue without a memory:
/// the stored slopes integrated twice here, knot by knot, without the runtime's own evaluation.
struct ModelEnergy {
  double normal = 0, lateral = 0;  ///< J
  double depth = 0;                ///< m
  double normal_force = 0;         ///< g, N
  Vec3 lateral_deflection{};       ///< S q, m
};
ModelEnergy model_energy(const Library& library, const runtime::ContactObservation& model,
                         const Vec3& x);

/// What the tissue under a contact remembers, by equations (R17) to (R33) of docs/theory-runtime.md
/// and the observations of the contact alone.
class MemoryTwin {
 public:
  explicit MemoryTwin(const Library& library)
      : library_(library),
        memory_(library.relaxation_times.size()),
        dragged_(library.relaxation_times.size()) {}

  /// Energy of a local model with the memory as it is, J.
  double energy(const runtime::ContactObservation& model, const Vec3& x) const;
  /// The lateral force of a local model with the memory and the grip as they are, N.
  Vec3 lateral_force(const runtime::ContactObservation& model, const Vec3& x) const;
  /// The same as the tool feels it: S times it, N.
  Vec3 felt_force(const runtime::ContactObservation& model, const Vec3& x) const;
  /// A step of dt (s) that led from one observation to the other, with the tip at x. @return what
  /// relaxation has dissipated, J.
  double step(const runtime::ContactObservation& before, const runtime::ContactObservation& after,
              const Vec3& x, double dt);
  void forget();
  /// N: by how much the lateral force after the last step has another direction than before the
  /// slip that followed its relaxing, (R25), or is larger; times what relaxes in the step, since
  /// the former is known from that.
  double misdirected() const { return misdirected_; }

 private:
  struct Sums {
    double relaxed = 0;  ///< F, N
    double stored = 0;   ///< K, J
    double locked = 0;   ///< R, J
  };
  std::vector<double> fractions(const runtime::SurfacePoint& p) const;
  Sums sums(const runtime::SurfacePoint& p, double factor = 1) const;
  static double normal_energy(const Sums& memory, const ModelEnergy& elastic);
  double carried(const runtime::SurfacePoint& p, double slid) const;
  double pass(const ModelEnergy& elastic, double dt);
  struct LateralSums {
    Vec3 relaxed{};     ///< M, N
    double stored = 0;  ///< K, J
  };
  bool drags() const;
  LateralSums lateral_sums() const;
  double lateral_energy(const Vec3& q) const;
  double lateral(double rho) const;
  double lateral_work(double rho) const;
  Vec3 gradient(const Vec3& q) const;
  Vec3 deflection_of(const Vec3& force, double longest) const;
  void keep(const std::vector<Vec3>& forces);
  std::vector<Vec3> shrunk(double depth, double& scale) const;
  runtime::Grip renew(const runtime::ContactObservation& model, const Vec3& x);
  void carry_lateral(const Vec3& normal, double slid);
  double pass_lateral(const runtime::ContactObservation& after, const Vec3& q, double dt);
  Vec3 target(const runtime::ContactObservation& after, const Vec3& q, double dt) const;
  double relaxing_part(double dt) const;
  bool has_lost(const runtime::ContactObservation& model, const Vec3& x) const;

  const Library& library_;
  std::vector<double> memory_;    ///< F_i, N
  std::vector<Vec3> dragged_;     ///< p_i, m: M_i is the lateral force there
  std::array<double, 3> held_{};  ///< weights of the lateral responses of the vertices of place_
  Vec3 normal_{};                 ///< to which they are tangential
  double misdirected_ = 0;        ///< N
  Sums now_;                      ///< at place_
  runtime::SurfacePoint place_;   ///< of the tissue that remembers
  Vec3 point_{};                  ///< the same, m
};

/// The factor of L in (C10): friction carries the change of the normal force over to the lateral
/// one, which has a change of its own: the larger eigenvalue of ((1 + mu^2, mu), (mu, 1)).
double relaxing_factor(double friction);

/// Steps a contact and keeps what the worst step did. The account is computed with model_energy.
class WatchedContact {
 public:
  WatchedContact(const Library& library, const palpate_library& body,
                 const runtime::ContactSettings& settings);

  /// dt: s; by default a random one, from 10 us to 1 s.
  std::uint32_t step(const Vec3& x);
  std::uint32_t step(const Vec3& x, double dt);
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
  /// good input; the bound plus what relaxation may change, by the energy that it dissipates,
  /// (C10).
  double steepest_step = 0;
  /// Largest excess of the lateral force over mu g; of decoupled responses over what one step of
  /// travel can give, (1 + mu) Lipschitz bound times the longest of the contact, of coupled ones
  /// over nothing but rounding.
  double largest_overdraft = 0;
  /// Lateral force of the runtime against that of the twin, over what a deflection that
  /// the runtime takes for none can give.
  double largest_lateral_error = 0;
  long dragged = 0;  ///< steps in which a lateral force had relaxed
  long apart = 0;    ///< steps in which the lateral offset was not zero

 private:
  void account(const Vec3& x, double dt, const runtime::ContactObservation& before);
  void compare(const Vec3& x, const runtime::ContactObservation& before);
  double overdraft(const runtime::ContactObservation& model, const Vec3& x) const;

  const Library& library_;
  runtime::ContactState contact_;
  MemoryTwin memory_;
  std::mt19937_64 random_{7};
  double largest_fraction_ = 0;  ///< sum of g_i
  double relaxed_ = 0;           ///< J, in this step
  double bound_ = 0;             ///< N/m
  double friction_ = 0;
  double longest_ = 0;  ///< m, step of the contact
  Vec3 last_{};
  double work_ = 0;
};

}  // namespace palpate::test
