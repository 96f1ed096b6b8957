// SPDX-License-Identifier: Apache-2.0
#include "runtime/contact_state.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/sliding.hpp"
#include "runtime/status.hpp"

namespace palpate::runtime {
namespace {

constexpr double kRelaxed = 1e-11;  // m; a lateral deflection this small stores no energy (1e-19 J)
constexpr int kActivationPasses = 24;  // each gains at least a digit where the surface is smooth
constexpr int kRelaxedPasses = 8;
constexpr double kRecoveryFraction = 0.5;  // of the travel of the tip: how fast the offset returns
constexpr double kRounding = 1e-12;        // N; tolerance of the limit on the change of force
constexpr int kRateLimitTries = 5;         // shorter slides that are tried before c stays fixed

/// The fraction in [0, 1] of the straight path from `near`, no longer than `allowed`, to `far`,
/// which is longer, at which the vector reaches the length `allowed`. One half when both are
/// longer.
double fraction_within(const Vec3& near, const Vec3& far, double allowed) noexcept {
  const Vec3 path = far - near;
  const double a = dot(path, path);
  const double b = dot(near, path);
  const double c = allowed * allowed - dot(near, near);
  return c > 0 ? c / (b + std::sqrt(b * b + a * c)) : 0.5;
}

}  // namespace

ContactState::ContactState(const Surface& surface, const CollisionTree& tree,
                           const ContactSettings& settings) noexcept
    : surface_(&surface),
      tree_(&tree),
      settings_(settings),
      tank_(settings.tank_cap),
      memory_(surface) {}

void ContactState::reset() noexcept {
  model_.reset();
  approaching_.reset();
  last_.reset();
  tank_.empty();
  memory_.forget();
  goal_ = 0;
  suspended_ = false;
  unsettled_ = {};
  dissipated_ = 0;
  seen_ = {};
}

void ContactState::forget() noexcept {
  if (unsettled_.any) settle();
  memory_.forget();
  seen_.energy = 0;
}

void ContactState::set_delivery(const Delivery* delivered) noexcept {
  delivered_ = delivered;
  const bool late = delivered != nullptr && delivered->entry.element != kNoElement;
  if (late && !model_ && !approaching_) approaching_ = delivered->entry;
}

std::uint32_t ContactState::refuse() noexcept {
  seen_.status = step_status::BadInput;
  drop();
  return seen_.status;
}

std::uint32_t ContactState::suspend(const Vec3& x) noexcept {
  if (!is_finite(x)) return refuse();
  seen_.status = 0;
  tank_.empty();
  seen_.tank = 0;
  drop();
  last_ = x;
  suspended_ = true;
  return seen_.status;
}

std::uint32_t ContactState::step(const Vec3& x, double dt) noexcept {
  if (!is_finite(x)) return refuse();
  dt_ = dt > 0 ? dt : 0;  // the clock of a recording may go back
  const Vec3 from = last_.value_or(x);
  const double travelled = norm(x - from);
  last_ = x;
  if (!(travelled <= surface_->diagonal())) return refuse();
  seen_.status = 0;
  if (model_) touch(x, travelled);
  if (suspended_) resume(x);
  if (!model_ && memory_.remembers()) relax_freely();
  if (!model_) detect(from, x);
  if (model_) seen_.status |= step_status::Contact;
  return seen_.status;
}

void ContactState::detect(const Vec3& from, const Vec3& x) noexcept {
  const SurfacePoint crossed = entry(from, x);
  if (crossed.element != kNoElement) approaching_ = crossed;
  if (!approaching_) return;
  const auto facing_from = [&](const SurfacePoint& point) {
    return project(*surface_, point, x, kActivationPasses, kRelaxed, delivered_);
  };
  const Projection facing = facing_from(*approaching_);
  if (begin_at(facing, x)) return;
  // No point near the entry faces the tip, or it takes more passes to find. The closest point tells
  // whether the tip is inside, and may be a better start.
  approaching_.reset();
  const SurfacePoint closest = closest_if_inside(x);
  if (closest.element == kNoElement) return;
  const Projection again = facing_from(closest);
  if (begin_at(again, x)) return;
  approaching_ = again.lateral < facing.lateral ? again.point : facing.point;
}

/// After a suspension the contact begins where the tip is, if it is inside.
void ContactState::resume(const Vec3& x) noexcept {
  suspended_ = false;
  const SurfacePoint closest = closest_if_inside(x);
  if (closest.element != kNoElement) approaching_ = closest;
}

SurfacePoint ContactState::entry(const Vec3& from, const Vec3& to) const noexcept {
  if (delivered_ == nullptr) return tree_->first_entry(from, to);
  return first_entry(*surface_, delivered_->elements(), from, to);
}

/// The closest point of the surface when the tip is on its inner side and not deeper than the
/// deepest sample; else none. The side is certain also at edges, as u_l . facet normal > 0 in every
/// triangle.
SurfacePoint ContactState::closest_if_inside(const Vec3& x) const noexcept {
  const SurfacePoint p = delivered_ == nullptr
                             ? tree_->nearest(x, surface_->deepest())
                             : nearest(*surface_, delivered_->elements(), x, surface_->deepest());
  if (p.element == kNoElement) return p;
  const bool inside = dot(x - surface_->position(p), surface_->normal(p)) > 0;
  return inside ? p : SurfacePoint{};
}

/// Begins the contact at a point that faces the tip: x - c parallel to n(c), the tip on the inner
/// side.
bool ContactState::begin_at(const Projection& facing, const Vec3& x) noexcept {
  if (facing.lateral > kRelaxed) return false;
  LocalModel model(*surface_, facing.point, 0);
  set_memory_at_point(model, Shear::Lost);
  const double depth = model.deflection(x).geometric;
  if (!(depth >= 0 && depth <= surface_->deepest())) return false;
  model.set_offset(depth);
  approaching_.reset();
  seen_.status |= step_status::Activated;
  Candidate first{model, {}, {}, depth};
  respond(first, x);
  commit(first, seen_.energy);
  return true;
}

void ContactState::touch(const Vec3& x, double travelled) noexcept {
  const Deflection before = model_->deflection(x);
  const double allowance = std::isinf(settings_.lipschitz_bound)
                               ? settings_.lipschitz_bound  // also at rest
                               : settings_.lipschitz_bound * travelled;
  // In its place at once: a copy would wait for what has just been stored.
  const bool coupled = model_->coupled();
  FixedContact fixed{before, model_->respond(before, pieces_), travelled, allowance,
                     !coupled && exceeds_friction(fixed.response, 0)
                         ? slip_to_limit(*model_, before, fixed.response)
                         : LateralSlip{}};
  const double let_go = coupled ? hold(fixed) : 0;
  // What is stored is found in two parts, as the slip and the walk wait for their roots and leave
  // the processor time for it.
  const bool settles = unsettled_.any && needs_stored(fixed);
  if (settles) memory_.find_normal();
  const SlideFractions whole{.recovery = kRecoveryFraction * travelled};
  std::uint32_t status = 0;
  Candidate next{slide(x, fixed, whole, status), {}, {}, goal_};
  next.status = status;
  const double energy_last = settles          ? settle(fixed.response)  // E_{i-1}(x_{i-1})
                             : unsettled_.any ? unsettled_.energy
                                              : seen_.energy;
  const double energy_before = fixed.response.energy + let_go;  // E_{i-1}(x_i)
  seen_.absorbed += energy_before - energy_last;
  choose(next, x, fixed, whole);
  seen_.status |= next.status;
  if (release(next, x, energy_before)) return;
  if (next.model.contact_point() != model_->contact_point()) seen_.status |= step_status::Sliding;
  commit(next, energy_before);
}

/// The contact grows or shrinks with the depth; then its slip is known. @return what its energy
/// falls by, J
double ContactState::hold(FixedContact& fixed) noexcept {
  double energy = fixed.response.energy;
  if (memory_.relaxes()) {
    const GripChange change = model_->grip_change(fixed.deflection, pieces_);
    const bool remembers = change.any() && model_->memory().lateral.any;
    if (remembers && unsettled_.any) {
      settle(fixed.response);
      energy = fixed.response.energy;
    }
    model_->renew_grip(change, fixed.deflection, fixed.response, pieces_, memory_);
    if (remembers) {
      memory_.carry(model_->place(), model_->memory(), {});
      model_->set_memory(memory_.now());
    }
  } else {
    model_->renew_grip(fixed.deflection, fixed.response, pieces_);
  }
  if (exceeds_friction(fixed.response, 0))
    fixed.slip = slip_to_limit(*model_, fixed.deflection, fixed.response);
  return energy - fixed.response.energy;
}

/// Is the lateral force above mu g by more than `tolerated` (N)? Out of normal contact mu g is 0.
bool ContactState::exceeds_friction(const LocalResponse& r, double tolerated) const noexcept {
  return r.lateral_force > settings_.friction * r.friction_normal_force + tolerated;
}

/// The slip of a response that exceeds friction.
LateralSlip ContactState::slip_to_limit(const LocalModel& model, const Deflection& at,
                                        const LocalResponse& response) const noexcept {
  return model.slip_within(at, response, settings_.friction * response.friction_normal_force,
                           pieces_);
}

/// Is there no normal contact: the tip is outside, or above the skin, which lags behind it?
bool ContactState::is_lost(const FixedContact& fixed) const noexcept {
  return !(fixed.deflection.depth > 0) || (memory_.relaxes() && fixed.response.relaxed.scale == 0);
}

/// Does c follow the tip, so that it is opposite to it?
bool ContactState::stays_opposite(const FixedContact& fixed,
                                  const SlideFractions& fractions) const noexcept {
  return is_lost(fixed) && fractions.follow == 1;
}

/// Does the force change by at most `allowed` (N; infinite: any change)?
bool ContactState::may_change_to(const Candidate& c, double allowed) const noexcept {
  const Vec3 change = c.response.force - seen_.force;
  return dot(change, change) <= allowed * allowed;
}

/// The slide and the return of the offset as far as the force may change in this step. next: the
/// model after the whole slide.
void ContactState::choose(Candidate& next, const Vec3& x, const FixedContact& fixed,
                          const SlideFractions& whole) const noexcept {
  const double allowed = fixed.allowance + kRounding;
  const auto within = [&](const Candidate& c) { return may_change_to(c, allowed); };
  finish(next, x, fixed, whole);
  if (within(next)) return;
  next = move(x, fixed, {});
  const std::uint32_t obstacles = next.status & (step_status::AtBorder | step_status::Awaiting);
  if (!within(next)) next = rate_limited(x, fixed, next, allowed);
  next.status |= obstacles | step_status::ForceLimited;
}

/// The largest part of a slide that the limit on the change of force allows. With c fixed the tool
/// slips over it, which is within a certified limit from any state inside the friction cone; from a
/// state outside it the tool slips in part. The first try for the motion of c interpolates the
/// change of force linearly over its whole path. That path may cross an edge of the body, so the
/// next tries are the travel of the tip and ever shorter motions.
ContactState::Candidate ContactState::rate_limited(const Vec3& x, const FixedContact& fixed,
                                                   const Candidate& whole,
                                                   double allowed) const noexcept {
  const auto change = [&](const Candidate& c) { return c.response.force - seen_.force; };
  const auto within = [&](const Candidate& c) { return may_change_to(c, allowed); };
  const Candidate slipping = move(x, fixed, {.follow = 0});
  const bool may_follow = within(slipping);
  Candidate base =
      may_follow ? slipping : Candidate{*model_, fixed.deflection, fixed.response, goal_};
  Candidate next = may_follow ? whole : slipping;
  double fraction = 1;
  for (int i = 0; i < kRateLimitTries; ++i) {
    const double line = 0.9 * fraction_within(change(base), change(next), allowed);
    fraction *= std::clamp(line, 0.02, may_follow && i > 1 ? 0.25 : 0.9);
    if (may_follow && i == 1) fraction = std::min(fraction, fixed.travelled / norm(lag(fixed)));
    next = move(x, fixed,
                may_follow ? SlideFractions{.follow = fraction}
                           : SlideFractions{.follow = 0, .slip = fraction});
    if (within(next)) return next;
  }
  return base;
}

/// The model after these fractions of the slide, with an offset that keeps the energy in the
/// budget.
ContactState::Candidate ContactState::move(const Vec3& x, const FixedContact& fixed,
                                           const SlideFractions& fractions) const noexcept {
  std::uint32_t status = 0;
  Candidate next{slide(x, fixed, fractions, status), {}, {}, goal_};
  next.status = status;
  finish(next, x, fixed, fractions);
  return next;
}

/// The rest of a motion of which the model after the slide is known.
void ContactState::finish(Candidate& next, const Vec3& x, const FixedContact& fixed,
                          const SlideFractions& fractions) const noexcept {
  next.deflection = next.model.deflection(x);
  next.is_opposite = stays_opposite(fixed, fractions);
  set_memory_at_point(next.model, next.is_opposite ? Shear::Lost : Shear::Kept);
  double recovery = fractions.recovery;
  if (!(next.deflection.depth > 0)) {
    // Out of normal contact but perhaps inside the body: the offset follows the tip outwards, which
    // takes no energy, until it is back at the true surface.
    const double rearmed = std::min(next.model.offset(), std::max(next.deflection.geometric, 0.0));
    next.goal = std::min(goal_, rearmed);
    next.model.set_offset(rearmed);
    next.deflection = next.model.deflection(x);
    recovery = 0;
  }
  if (next.is_opposite) {
    next.model.let_go(x, kRelaxed);
    next.deflection = next.model.deflection(x);
  }
  next.model.respond(next.deflection, pieces_, next.response);
  if (settings_.budget == EnergyBudget::Enforced) enforce_budget(next, x, fixed, recovery);
  renew_grip(next);
  if (fractions.slip == 1) enforce_friction(next, fixed.allowance);
}

void ContactState::renew_grip(Candidate& at) const noexcept {
  if (!at.model.coupled()) return;
  if (memory_.relaxes())
    at.model.renew_grip(at.model.grip_change(at.deflection, pieces_), at.deflection, at.response,
                        pieces_, memory_);
  else
    at.model.renew_grip(at.deflection, at.response, pieces_);
}

/// Where no offset keeps a slide in the budget c stays fixed and the tool slips over it: with c
/// fixed slip lowers the energy.
void ContactState::enforce_budget(Candidate& moved, const Vec3& x, const FixedContact& fixed,
                                  double recovery) const noexcept {
  const EnergyVerdict verdict = judge(moved.model, x, moved.response,
                                      tank_.budget(fixed.response.energy), moved.goal, recovery);
  if (!verdict.limited && verdict.offset == moved.model.offset()) return;
  if (verdict.limited) moved.status |= step_status::EnergyLimited;
  if (verdict.fix_contact_point) {
    moved.model = slip_at_fixed_point(fixed, 1);
    moved.goal = goal_;
  } else {
    moved.model.set_offset(verdict.offset);
    if (moved.is_opposite) moved.model.let_go(x, kRelaxed);
  }
  respond(moved, x);
}

void ContactState::respond(Candidate& at, const Vec3& x) const noexcept {
  at.deflection = at.model.deflection(x);
  at.model.respond(at.deflection, pieces_, at.response);
}

/// Slips where a slide or a change of the offset has left a lateral force above mu g: coupled
/// responses by all of it, as their bound is valid up to the slip limit; decoupled responses, whose
/// bound is valid everywhere, by what exceeds the allowance of one step. The next slide of c
/// releases the rest.
void ContactState::enforce_friction(Candidate& moved, double allowance) const noexcept {
  if (!exceeds_friction(moved.response, moved.model.coupled() ? 0 : allowance)) return;
  const LateralSlip slip = slip_to_limit(moved.model, moved.deflection, moved.response);
  moved.model.slip(slip, moved.deflection, moved.response, pieces_);
}

LocalModel ContactState::slide(const Vec3& x, const FixedContact& fixed,
                               const SlideFractions& fractions,
                               std::uint32_t& status) const noexcept {
  if (fractions.follow == 0) return slip_at_fixed_point(fixed, fractions.slip);
  if (stays_opposite(fixed, fractions)) return stay_opposite(x, status);
  const bool apart = model_->lateral_offset() != Vec3{};
  if (!apart && !(fixed.slip.distance > 0)) return *model_;
  return follow(fixed, fractions.follow, apart, status);
}

/// Where the lateral deflection exceeds the slip limit the anchor c + s moves by the slip, and c
/// moves a fraction of the path to it; the rest stays in s. Where nothing hinders c, s
/// stays zero: the next step corrects what the curvature of the surface leaves in an ordinary
/// slide.
LocalModel ContactState::follow(const FixedContact& fixed, double fraction, bool apart,
                                std::uint32_t& status) const noexcept {
  const Vec3 path = lag(fixed);
  const double distance = apart ? norm(path) : fixed.slip.distance;
  const Vec3 direction = apart ? path : fixed.slip.direction;
  const Walk moved = walk(*surface_, model_->point(), direction, fraction * distance, delivered_);
  if (moved.at_border) status |= step_status::AtBorder;
  if (moved.awaiting) status |= step_status::Awaiting;
  LocalModel next = model_->moved_to(moved.point, pieces_);
  if (apart || moved.hindered || fraction != 1) {
    next.set_lateral_offset(path - (next.contact_point() - model_->contact_point()));
    if (fraction == 1 && norm(next.lateral_offset()) <= kRelaxed) next.set_lateral_offset({});
  }
  return next;
}

/// From c to the anchor once it has slipped.
Vec3 ContactState::lag(const FixedContact& fixed) const noexcept {
  return model_->lateral_offset() + fixed.slip.part(1);
}

/// Out of normal contact there is no friction: c follows the tip until x - c is parallel to n. What
/// lateral deflection is then left goes into s, see move().
LocalModel ContactState::stay_opposite(const Vec3& x, std::uint32_t& status) const noexcept {
  const Projection p = project(*surface_, model_->point(), x, kRelaxedPasses, kRelaxed, delivered_);
  if (p.at_border) status |= step_status::AtBorder;
  if (p.awaiting) status |= step_status::Awaiting;
  return {*surface_, p.point, model_->offset()};
}

/// c stays fixed; a fraction of the slip goes into s.
LocalModel ContactState::slip_at_fixed_point(const FixedContact& fixed,
                                             double fraction) const noexcept {
  LocalModel next = *model_;
  next.set_lateral_offset(model_->lateral_offset() + fixed.slip.part(fraction));
  return next;
}

/// The contact ends when the tip is out of normal contact and outside the body, and the lateral
/// deflection has relaxed: no energy is stored then.
bool ContactState::release(const Candidate& moved, const Vec3& x, double energy_before) noexcept {
  const Deflection& d = moved.deflection;
  const Element& e = surface_->element(moved.model.point().element);
  if (d.depth > 0 || surface_->outside_distance(e, x) < 0) return false;
  if (d.lateral > kRelaxed) return false;  // the force still falls
  if (norm(moved.model.lateral_offset()) > kRelaxed) {
    // The triangles for c have not been delivered; or c is not opposite to the tip, so that its
    // plane does not decide on which side the tip is.
    if (moved.status & step_status::Awaiting) return false;
    if (closest_if_inside(x).element != kNoElement) return false;
  }
  tank_.settle(energy_before, memory_.locked());
  seen_.status |= step_status::Released;
  free_contact();
  return true;
}

void ContactState::commit(Candidate& next, double energy_before) noexcept {
  tank_.settle(energy_before, next.response.energy);
  if (memory_.relaxes()) relax(next);
  const bool same_element = model_ && model_->point().element == next.model.point().element;
  model_ = next.model;
  if (ahead_ != kNoElement || !same_element) look_ahead(next.deflection);
  goal_ = next.goal;
  if (next.deflection.depth > next.model.deepest()) seen_.status |= step_status::BeyondDepth;
  seen_.point = next.model.point();
  seen_.contact_point = next.model.contact_point();
  seen_.normal = next.model.normal();
  seen_.deflection = next.deflection;
  seen_.grip = next.model.grip();
  seen_.lateral_displacement = next.model.lateral_displacement(next.deflection);
  seen_.shear = next.model.shear(next.deflection);
  seen_.lateral_distance = next.model.lateral_distance(next.deflection);
  seen_.offset = next.model.offset();
  seen_.lateral_offset = next.model.lateral_offset();
  seen_.energy = next.response.energy;
  unsettled_.energy = next.response.energy;
  seen_.force = next.response.force;
  seen_.tank = tank_.level();
}

/// Gives the model what the tissue at its contact point remembers.
void ContactState::set_memory_at_point(LocalModel& model, Shear shear) const noexcept {
  if (!memory_.relaxes()) return;
  const double slid = norm(model.contact_point() - remembering_point_);
  model.set_memory(memory_.carried_to(model.place(), slid, shear));
}

/// The time of the step passes with the tip where it is. What friction then no longer holds slips.
void ContactState::relax(Candidate& at) noexcept {
  const LocalModel& model = at.model;
  LocalResponse& response = at.response;
  const LateralMemory& lateral = model.memory().lateral;
  const bool slid_and_holds = model_ && lateral.slide != 0 && lateral.grip != 0;
  memory_.carry(model.place(), model.memory(),
                slid_and_holds ? model.weights_of(model_->grip()) : Vec3{});
  remembering_point_ = model.contact_point();
  memory_.pass(response.relaxed.instant.force, dt_);
  memory_.pass_lateral(response.instant_lateral_force * at.deflection.tangent,
                       at.deflection.lateral);
  const double energy_before = response.energy;
  const double normal_before = response.friction_normal_force;
  const double held = std::max(settings_.friction * normal_before, response.lateral_force);  // N
  at.model.replace_memory(memory_.now(), at.deflection, response);
  unsettled_.any = true;
  unsettled_.known = false;
  unsettled_.lags = response.relaxed.scale == 0;
  unsettled_.falls_by += energy_before - response.energy;
  seen_.relaxed_fraction = 1 - response.relaxed.scale;
  seen_.relaxed_lateral_force = model.memory().lateral.relaxed();
  if (at.deflection.depth > 0 && response.relaxed.scale == 0) seen_.status |= step_status::SkinLags;
  const double limit = held - settings_.friction * (normal_before - response.friction_normal_force);
  if (!(response.lateral_force > limit)) return;
  at.model.slip(model.slip_within(at.deflection, response, limit, pieces_), at.deflection, response,
                pieces_);
}

/// May a step change more than the tip, so that E changes by more than without what is stored?
/// Where c, s and d0 stay, and the skin does not lag, K is the same before and after, and cancels.
bool ContactState::needs_stored(const FixedContact& fixed) const noexcept {
  return unsettled_.lags || is_lost(fixed) || fixed.slip.distance > 0 ||
         model_->lateral_offset() != Vec3{} || model_->offset() > goal_;
}

/// What the last step has left stored. No force needs it before a step judges a slide by it.
void ContactState::find_stored() const noexcept {
  const double stored = memory_.find_stored(unsettled_.lags);
  seen_.energy = unsettled_.energy + stored;
  seen_.dissipated = dissipated_ + (unsettled_.falls_by - stored);
  unsettled_.known = true;
}

/// The same for a step that needs it: for the model, its response and the account. @return the
/// energy at the end of the last step, J
double ContactState::settle(LocalResponse& response) noexcept {
  settle();
  model_->add_stored(memory_.now(), response);
  return seen_.energy;
}

/// The energies of the last steps are complete.
void ContactState::settle() noexcept {
  memory_.settle();
  if (!unsettled_.known) find_stored();
  dissipated_ = seen_.dissipated;
  unsettled_ = {};
}

/// The same without a tool: the skin moves back.
void ContactState::relax_freely() noexcept {
  const double energy_before = memory_.locked();
  memory_.pass(0, dt_);
  memory_.settle();
  seen_.energy = memory_.locked();
  dissipated_ += energy_before - seen_.energy;
  seen_.dissipated = dissipated_;
  dt_ = 0;
}

/// Prefetches what the contact point may reach in the next steps.
void ContactState::look_ahead(const Deflection& at) noexcept {
  const std::int32_t now = model_->point().element;
  const NodeCurves::InUse in_use = model_->curves_in_use(at);
  if (ahead_ != kNoElement) surface_->prefetch_beyond(ahead_, in_use);
  if (ahead_ != now) surface_->prefetch_around(now, in_use);
  ahead_ = ahead_ == now ? kNoElement : now;
}

void ContactState::free_contact() noexcept {
  model_.reset();
  memory_.forget_lateral();
  const std::uint32_t status = seen_.status;
  const double absorbed = seen_.absorbed;
  const double dissipated = seen_.dissipated;
  seen_ = {};
  seen_.status = status;
  seen_.absorbed = absorbed;
  seen_.dissipated = dissipated;
  seen_.energy = memory_.locked();
  seen_.tank = tank_.level();
}

void ContactState::drop() noexcept {
  approaching_.reset();
  forget();
  if (!model_) return;
  seen_.status |= step_status::Dropped;
  free_contact();
}

}  // namespace palpate::runtime
