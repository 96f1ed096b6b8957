// SPDX-License-Identifier: Apache-2.0
// One tool tip on one body: collision, sliding, energy account, release.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "format/vec3.hpp"
#include "runtime/collision.hpp"
#include "runtime/energy_rule.hpp"
#include "runtime/local_model.hpp"
#include "runtime/relaxation.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// Whether a slide must stay within the energy budget. `Ignored` is the rule of the paper, which
/// can create energy: tests use it to show what the budget prevents; no interface offers it.
enum class EnergyBudget : std::uint8_t { Enforced, Ignored };

struct ContactSettings {
  double friction = 0;     ///< mu >= 0
  double tank_cap = 5e-3;  ///< J; 0 = strict Theorem 2
  EnergyBudget budget = EnergyBudget::Enforced;
  /// N/m, >= L_min: between two steps the force changes by at most this times the travel of the tip
  /// (see ContactState).
  double lipschitz_bound = std::numeric_limits<double>::infinity();
};

/// The state after a step; the fields are those of palpate_observation.
struct ContactObservation {
  std::uint32_t status = 0;  ///< step_status bits
  SurfacePoint point;
  Vec3 contact_point{};
  Vec3 normal{};
  Deflection deflection;
  Vec3 lateral_displacement{};  ///< q + e and the shear, m: of the tip from the anchor, across n
  Vec3 shear{};                 ///< of a straight press, by the lean, m
  double lateral_distance = 0;  ///< its length, m
  double offset = 0;            ///< d0, m
  Vec3 lateral_offset{};        ///< s, m
  Grip grip;
  double energy = 0;      ///< E_i(x_i), J; of a memory also without contact
  double tank = 0;        ///< J
  double absorbed = 0;    ///< J
  Vec3 force{};           ///< f, of the tool ON the body, N
  double dissipated = 0;  ///< J, by relaxation since the start
  double relaxed_fraction =
      0;  ///< 1 - psi: fraction of the instantaneous normal force that has relaxed
  Vec3 relaxed_lateral_force{};  ///< M, N: part of the instantaneous lateral force
};

/// The contact of one tip with one surface, advanced one sample of the force loop at a time:
///
///   free --(outside -> inside crossing)--> approaching --(x - c parallel to n)--> touching
///   touching --(z <= 0 and outside)--> free
///
/// While approaching, the contact point is tracked, no model is active and the force is zero. This
/// normally ends in the same step; it lasts only where no point of the surface faces the tip
/// (beyond a border). On activation d0 = n . (x - c), so that E = 0.
///
/// At every instant absorbed >= tank + E + dissipated >= 0.
///
/// Between two steps |f_i(x_i) - f_{i-1}(x_{i-1})| <= L |x_i - x_{i-1}| with L the Lipschitz bound,
/// except where a contact is dropped. With a fixed contact point this is true for every L >= L_min.
/// A slide, or a change of the offset, that exceeds it is rate-limited: it is made in part, and
/// the rest in later steps. So the condition of Theorem 1 [Mahvash & Hayward 2005, eq. 33] is met
/// in every sample, also at edges, at borders and by the energy rule.
///
/// Where friction slips but c cannot follow (at a border, at an edge whose neighbour has not been
/// delivered, in a rate-limited slide) the lateral offset s takes the motion that c leaves, so
/// that the lateral force does not exceed mu g; c moves to c + s as soon as it can.
///
/// Tissue that relaxes (theory-runtime, "Relaxation") does so at the end of a step, at the tip
/// where it then is: the force changes by that as well, also where the tip rests. The energies that
/// it then stores are found by the first of observation() and the next step that needs them: one in
/// which c, s or d0 may change, or which begins or ends where the skin lags.
///
/// step() is noexcept, allocation-free and bounded. One object belongs to one thread at a time; the
/// surface and the tree may be shared.
class ContactState {
 public:
  ContactState(const Surface& surface, const CollisionTree& tree,
               const ContactSettings& settings) noexcept;

  /// Advances to the tip position x (m) and returns the status bits. A position that is not finite,
  /// or farther from the last than the diagonal of the body, drops the contact: force zero,
  /// BadInput. dt: s since the last step, in which the tissue relaxes; none passes for dt <= 0 or
  /// NaN. Elastic responses do not depend on it.
  std::uint32_t step(const Vec3& x, double dt = 0) noexcept;
  /// A step with unusable input: force zero, the contact is dropped.
  std::uint32_t refuse() noexcept;
  /// No contact at the tip position x (m), which counts as the last one: the contact is dropped,
  /// its stored energy and the energy tank are discarded. The next step begins it anew where the
  /// tip is then, also inside the body, with d0 = n . (x - c): without force and energy.
  std::uint32_t suspend(const Vec3& x) noexcept;
  /// From the next step on the tool can meet, and slide onto, these triangles only, until the next
  /// call; null: all triangles. The delivery must outlive its use.
  void set_delivery(const Delivery* delivered) noexcept;
  /// The tissue is as new. @pre no contact
  void forget() noexcept;
  /// Resets the contact, the last position and the energies.
  void reset() noexcept;

  const ContactObservation& observation() const noexcept {
    if (unsettled_.any && !unsettled_.known) find_stored();
    return seen_;
  }
  /// The same in less time, but for energy and dissipated, which do not yet count what the tissue
  /// stores after the step.
  const ContactObservation& observation_but_energies() const noexcept { return seen_; }

 private:
  void detect(const Vec3& from, const Vec3& x) noexcept;
  void resume(const Vec3& x) noexcept;
  bool begin_at(const Projection& facing, const Vec3& x) noexcept;
  SurfacePoint entry(const Vec3& from, const Vec3& to) const noexcept;
  SurfacePoint closest_if_inside(const Vec3& x) const noexcept;
  /// A model for the next step and its response.
  struct Candidate {
    LocalModel model;
    Deflection deflection;
    LocalResponse response;
    double goal = 0;
    std::uint32_t status = 0;
    bool is_opposite = false;  ///< c follows the tip, and q = 0
  };

  /// The part of a slide that a step makes.
  struct SlideFractions {
    double follow = 1;    ///< fraction of the path of c to the anchor c + s
    double slip = 1;      ///< fraction of the excess over the slip limit
    double recovery = 0;  ///< m, largest return of the offset
  };
  /// The model before the step, with its contact point fixed, at the tip position after it.
  struct FixedContact {
    Deflection deflection;
    LocalResponse response;
    double travelled = 0;  ///< m, travel of the tip in this step
    double allowance = 0;  ///< N, largest change of the force
    LateralSlip slip;      ///< from beyond the slip limit
  };

  /// What is left to find of the energies of the last steps: those that the memories store after
  /// their times. As long as c, s and d0 stay, what is stored before a step is what was stored
  /// after the one before, and only the last is missing. No force depends on whether somebody has
  /// asked.
  struct Unsettled {
    bool any = false;
    bool known = false;   ///< seen_ has them, as somebody has asked
    bool lags = false;    ///< the skin behind the tool, so that R is stored instead of K
    double falls_by = 0;  ///< J, energy by relaxing, but for what the memories store afterwards
    double energy = 0;    ///< J, at the end of the last step, without what the memories store
  };

  void touch(const Vec3& x, double travelled) noexcept;
  double hold(FixedContact& fixed) noexcept;
  bool exceeds_friction(const LocalResponse& r, double tolerated) const noexcept;
  bool is_lost(const FixedContact& fixed) const noexcept;
  bool stays_opposite(const FixedContact& fixed, const SlideFractions& fractions) const noexcept;
  bool may_change_to(const Candidate& c, double allowed) const noexcept;
  LateralSlip slip_to_limit(const LocalModel& model, const Deflection& at,
                            const LocalResponse& response) const noexcept;
  void choose(Candidate& next, const Vec3& x, const FixedContact& fixed,
              const SlideFractions& whole) const noexcept;
  void finish(Candidate& next, const Vec3& x, const FixedContact& fixed,
              const SlideFractions& fractions) const noexcept;
  Candidate rate_limited(const Vec3& x, const FixedContact& fixed, const Candidate& whole,
                         double allowed) const noexcept;
  Candidate move(const Vec3& x, const FixedContact& fixed,
                 const SlideFractions& fractions) const noexcept;
  LocalModel slide(const Vec3& x, const FixedContact& fixed, const SlideFractions& fractions,
                   std::uint32_t& status) const noexcept;
  LocalModel follow(const FixedContact& fixed, double fraction, bool apart,
                    std::uint32_t& status) const noexcept;
  Vec3 lag(const FixedContact& fixed) const noexcept;
  LocalModel stay_opposite(const Vec3& x, std::uint32_t& status) const noexcept;
  LocalModel slip_at_fixed_point(const FixedContact& fixed, double fraction) const noexcept;
  void respond(Candidate& at, const Vec3& x) const noexcept;
  void renew_grip(Candidate& at) const noexcept;
  void enforce_budget(Candidate& moved, const Vec3& x, const FixedContact& fixed,
                      double recovery) const noexcept;
  void enforce_friction(Candidate& moved, double allowance) const noexcept;
  bool release(const Candidate& moved, const Vec3& x, double energy_before) noexcept;
  void commit(Candidate& next, double energy_before) noexcept;
  void set_memory_at_point(LocalModel& model, Shear shear) const noexcept;
  void relax(Candidate& at) noexcept;
  bool needs_stored(const FixedContact& fixed) const noexcept;
  void find_stored() const noexcept;
  void settle() noexcept;
  double settle(LocalResponse& response) noexcept;
  void relax_freely() noexcept;
  void look_ahead(const Deflection& at) noexcept;
  void free_contact() noexcept;
  void drop() noexcept;

  const Surface* surface_;
  const CollisionTree* tree_;
  const Delivery* delivered_ = nullptr;  ///< null: every triangle
  ContactSettings settings_;
  EnergyTank tank_;
  std::optional<LocalModel> model_;          ///< touching
  std::optional<SurfacePoint> approaching_;  ///< entered, not yet active
  std::optional<Vec3> last_;                 ///< last usable tip position
  bool suspended_ = false;
  mutable Relaxation memory_;
  mutable Unsettled unsettled_;
  double dissipated_ = 0;            ///< J, but for what is unsettled
  Vec3 remembering_point_{};         ///< where the tissue of the memory is, m
  double dt_ = 0;                    ///< s, of this step
  double goal_ = 0;                  ///< offset the contact should return to, m
  mutable ToolPieces pieces_;        ///< of the last evaluation; results do not depend on them
  std::int32_t ahead_ = kNoElement;  ///< element whose surroundings the last step prefetched
  mutable ContactObservation seen_;
};

}  // namespace palpate::runtime
