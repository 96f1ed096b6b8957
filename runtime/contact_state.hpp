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
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// Whether a slide is held to the energy budget. `Ignored` is the rule of the paper, which can
/// create energy; it exists so that tests can show what the budget prevents, and no interface
/// offers it.
enum class EnergyBudget : std::uint8_t { Kept, Ignored };

struct ContactSettings {
  double friction = 0;     ///< mu >= 0
  double tank_cap = 5e-3;  ///< J; 0 = strict Theorem 2
  EnergyBudget budget = EnergyBudget::Kept;
  /// N/m, >= L_stick: between two steps the force changes by no more than this times the travel of
  /// the tip, whatever slides or offsets change (see ContactState).
  double lipschitz_bound = std::numeric_limits<double>::infinity();
};

/// What a step left behind; the fields are those of palpate_observation.
struct ContactObservation {
  std::uint32_t status = 0;  ///< bits of palpate.h
  SurfacePoint point;
  Vec3 contact_point{};
  Vec3 normal{};
  Deflection deflection;
  double offset = 0;      ///< d0, m
  Vec3 lateral_offset{};  ///< s, m
  double energy = 0;      ///< E_i(x_i), J
  double tank = 0;        ///< J
  double absorbed = 0;    ///< J
  Vec3 force{};           ///< f, of the tool ON the body, N
};

/// The contact of one tip with one surface, advanced one sample of the force loop at a time:
///
///   free --(outside -> inside crossing)--> approaching --(x - c parallel to n)--> touching
///   touching --(z <= 0 and outside)--> free
///
/// While approaching, the contact point is tracked but no model is active and the force is zero; it
/// normally lasts no step at all, and longer only where no point of the surface faces the tip
/// (beyond a border). On activation d0 = n . (x - c), so that E = 0.
///
/// At every instant absorbed >= tank + E >= 0.
///
/// Between two steps |f_i(x_i) - f_{i-1}(x_{i-1})| <= Lipschitz bound |x_i - x_{i-1}|, unless
/// DROPPED says otherwise. With the contact point held this is so for any Lipschitz bound that is
/// certified; a slide, or a change of the offset, that would exceed it is made in part, and the
/// rest in later steps. So the condition of Theorem 1 [Mahvash & Hayward 2005, eq. 33] is met in
/// every sample, also at edges, at borders and by the energy rule.
///
/// Where friction lets go but c cannot follow (a border, an edge whose neighbour has not come, a
/// slide that is held back) the lateral offset s takes what c does not, so that the lateral force
/// does not exceed mu g there; c catches up with c + s as soon as it may.
///
/// step() is noexcept, allocation-free and bounded. One
/// object belongs to one thread at a time; the surface and the tree may be shared.
class ContactState {
 public:
  ContactState(const Surface& surface, const CollisionTree& tree,
               const ContactSettings& settings) noexcept;

  /// Advances to the tip position x (m) and returns the status bits. A position that is not finite,
  /// or further from the last than the body is large, drops the contact: force zero, BAD_INPUT.
  std::uint32_t step(const Vec3& x) noexcept;
  /// A step whose input cannot be used: force zero, the contact dropped.
  std::uint32_t refuse() noexcept;
  /// From the next step on only these triangles are there to be met or slid onto, until the next
  /// call; null: all. The delivery must live as long as it is used.
  void set_delivery(const Delivery* delivered) noexcept;
  /// Forgets the contact, the last position and the account.
  void reset() noexcept;

  const ContactObservation& observation() const noexcept { return seen_; }

 private:
  void detect(const Vec3& from, const Vec3& x) noexcept;
  bool begin_at(const Projection& facing, const Vec3& x) noexcept;
  SurfacePoint entry(const Vec3& from, const Vec3& to) const noexcept;
  SurfacePoint closest_if_inside(const Vec3& x) const noexcept;
  /// A model for the next step and what led to it.
  struct Candidate {
    LocalModel model;
    Deflection deflection;
    LocalResponse response;
    double goal = 0;
    std::uint32_t status = 0;
  };

  /// How much a step takes of what the tip asks for.
  struct Shares {
    double follow = 1;    ///< of the way of c to the anchor
    double slip = 1;      ///< of the excess over the slip limit
    double recovery = 0;  ///< m, most that the offset may return
  };
  /// The model before the step at the tip position after it.
  struct Held {
    Deflection deflection;
    LocalResponse response;
    double travelled = 0;  ///< m, by the tip in this step
    double allowance = 0;  ///< N, that the force may change by
    double excess = 0;     ///< m, of the lateral deflection over the slip limit
  };

  void touch(const Vec3& x, double travelled) noexcept;
  bool exceeds_friction(const LocalResponse& r, double tolerated) const noexcept;
  bool may_change_to(const Candidate& c, double allowed) const noexcept;
  double slip_limit(const LocalModel& model, const Deflection& at,
                    const LocalResponse& response) const noexcept;
  Candidate choose(const Vec3& x, const Held& held) const noexcept;
  Candidate hold_back(const Vec3& x, const Held& held, const Candidate& asked,
                      double allowed) const noexcept;
  Candidate move(const Vec3& x, const Held& held, const Shares& shares) const noexcept;
  LocalModel slide(const Vec3& x, const Held& held, const Shares& shares,
                   std::uint32_t& status) const noexcept;
  LocalModel follow(const Held& held, double share, bool apart,
                    std::uint32_t& status) const noexcept;
  Vec3 lag(const Held& held) const noexcept;
  LocalModel relax(const Vec3& x, std::uint32_t& status) const noexcept;
  LocalModel let_go(const Held& held, double share) const noexcept;
  void respond(Candidate& at, const Vec3& x) const noexcept;
  void keep_budget(Candidate& moved, const Vec3& x, const Held& held,
                   double recovery) const noexcept;
  void keep_friction(Candidate& moved, double allowance) const noexcept;
  bool release(const Candidate& moved, const Vec3& x, double energy_before) noexcept;
  void commit(const Candidate& next, double energy_before) noexcept;
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
  double goal_ = 0;                          ///< offset the contact should return to, m
  mutable PiecesInUse pieces_;       ///< of the last evaluation; its result does not depend on them
  std::int32_t ahead_ = kNoElement;  ///< element whose surroundings were asked for in the last step
  ContactObservation seen_;
};

}  // namespace palpate::runtime
