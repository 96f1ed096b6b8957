// SPDX-License-Identifier: Apache-2.0
#include "runtime/contact_state.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/palpate.h"
#include "runtime/sliding.hpp"

namespace palpate::runtime {
namespace {

constexpr double kRelaxed = 1e-11;  // m; a lateral deflection this small stores no energy (1e-19 J)
constexpr int kActivationPasses = 24;  // each gains at least a digit where the surface is smooth
constexpr int kRelaxedPasses = 8;
constexpr double kRecoveryShare = 0.5;  // of the tip's travel: how fast the offset may return
constexpr double kRounding = 1e-12;     // N; what the limit on the change of force overlooks
constexpr int kShorterSlides = 5;       // tries, before the contact point is held

bool finite(const Vec3& v) noexcept {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// Where a straight way from `near`, no longer than `allowed`, to `far`, which is longer, becomes
/// too long: its share, in [0, 1]. Half of the way when both are too long.
double share_within(const Vec3& near, const Vec3& far, double allowed) noexcept {
  const Vec3 way = far - near;
  const double a = dot(way, way);
  const double b = dot(near, way);
  const double c = allowed * allowed - dot(near, near);
  return c > 0 ? c / (b + std::sqrt(b * b + a * c)) : 0.5;
}

}  // namespace

ContactState::ContactState(const Surface& surface, const CollisionTree& tree,
                           const ContactSettings& settings) noexcept
    : surface_(&surface), tree_(&tree), settings_(settings), tank_(settings.tank_cap) {}

void ContactState::reset() noexcept {
  model_.reset();
  approaching_.reset();
  last_.reset();
  tank_.empty();
  goal_ = 0;
  seen_ = {};
}

void ContactState::set_delivery(const Delivery* delivered) noexcept {
  delivered_ = delivered;
  const bool late = delivered != nullptr && delivered->entry.element != kNoElement;
  if (late && !model_ && !approaching_) approaching_ = delivered->entry;
}

std::uint32_t ContactState::refuse() noexcept {
  seen_.status = PALPATE_BAD_INPUT;
  drop();
  return seen_.status;
}

std::uint32_t ContactState::step(const Vec3& x) noexcept {
  if (!finite(x)) return refuse();
  const Vec3 from = last_.value_or(x);
  const double travelled = norm(x - from);
  last_ = x;
  if (!(travelled <= surface_->diagonal())) return refuse();
  seen_.status = 0;
  if (model_) touch(x, travelled);
  if (!model_) detect(from, x);
  if (model_) seen_.status |= PALPATE_CONTACT;
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
  // No point near the entry faces the tip, or it takes more passes to find. The closest point says
  // whether to go on, and may be a better start.
  approaching_.reset();
  const SurfacePoint closest = closest_if_inside(x);
  if (closest.element == kNoElement) return;
  const Projection again = facing_from(closest);
  if (begin_at(again, x)) return;
  approaching_ = again.lateral < facing.lateral ? again.point : facing.point;
}

SurfacePoint ContactState::entry(const Vec3& from, const Vec3& to) const noexcept {
  if (delivered_ == nullptr) return tree_->first_entry(from, to);
  return first_entry(*surface_, delivered_->elements(), from, to);
}

/// The closest point of the surface when the tip is on its inner side and not deeper than the
/// deepest sample; else none. Sure of the side even at edges, as u_l . facet normal > 0 in every
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
  const double depth = model.deflection(x).geometric;
  if (!(depth >= 0 && depth <= surface_->deepest())) return false;
  model.set_offset(depth);
  approaching_.reset();
  seen_.status |= PALPATE_ACTIVATED;
  Candidate first{model, {}, {}, depth, 0};
  respond(first, x);
  commit(first, 0);
  return true;
}

void ContactState::touch(const Vec3& x, double travelled) noexcept {
  Held held;
  held.deflection = model_->deflection(x);
  held.response = model_->respond(held.deflection, pieces_);
  held.travelled = travelled;
  held.allowance = std::isinf(settings_.lipschitz_bound)
                       ? settings_.lipschitz_bound  // also at rest
                       : settings_.lipschitz_bound * travelled;
  if (exceeds_friction(held.response, 0)) {
    const double limit = slip_limit(*model_, held.deflection, held.response);
    held.excess = std::max(held.deflection.lateral - limit, 0.0);
  }
  const double energy_before = held.response.energy;  // E_{i-1}(x_i)
  seen_.absorbed += energy_before - seen_.energy;
  const Candidate next = choose(x, held);
  seen_.status |= next.status;
  if (release(next, x, energy_before)) return;
  if (next.model.contact_point() != model_->contact_point()) seen_.status |= PALPATE_SLIDING;
  commit(next, energy_before);
}

/// Is the lateral force above mu g by more than `tolerated` (N)? Out of normal contact mu g is 0.
bool ContactState::exceeds_friction(const LocalResponse& r, double tolerated) const noexcept {
  return r.lateral_force > settings_.friction * r.grip + tolerated;
}

/// Of a response that exceeds friction.
double ContactState::slip_limit(const LocalModel& model, const Deflection& at,
                                const LocalResponse& response) const noexcept {
  return model.slip_limit_below(at, response, settings_.friction, pieces_);
}

/// Does the force change by no more than `allowed` (N, infinite if any may)?
bool ContactState::may_change_to(const Candidate& c, double allowed) const noexcept {
  const Vec3 change = c.response.force - seen_.force;
  return dot(change, change) <= allowed * allowed;
}

/// The slide and the return of the offset as far as the force may change in this step.
ContactState::Candidate ContactState::choose(const Vec3& x, const Held& held) const noexcept {
  const double allowed = held.allowance + kRounding;
  const auto within = [&](const Candidate& c) { return may_change_to(c, allowed); };
  Candidate next = move(x, held, {.recovery = kRecoveryShare * held.travelled});
  if (within(next)) return next;
  next = move(x, held, {});
  const std::uint32_t obstacles = next.status & (PALPATE_AT_BORDER | PALPATE_AWAITING);
  if (!within(next)) next = hold_back(x, held, next, allowed);
  next.status |= obstacles | PALPATE_FORCE_LIMITED;
  return next;
}

/// As much of a slide as the limit on the change of force has room for. With c held the tool slips
/// over it, which is within a certified limit from any state in which friction holds; where more
/// was left over than the limit lets go of now, the tool slips in part. How far c may go is first
/// taken from the straight line over its whole way; that may lead over a seam of the body and say
/// nothing of the way to it, so the next tries are of the travel of the tip and of ever less.
ContactState::Candidate ContactState::hold_back(const Vec3& x, const Held& held,
                                                const Candidate& asked,
                                                double allowed) const noexcept {
  const auto change = [&](const Candidate& c) { return c.response.force - seen_.force; };
  const auto within = [&](const Candidate& c) { return may_change_to(c, allowed); };
  const Candidate slipping = move(x, held, {.follow = 0});
  const bool may_follow = within(slipping);
  const Candidate base =
      may_follow ? slipping : Candidate{*model_, held.deflection, held.response, goal_, 0};
  Candidate next = may_follow ? asked : slipping;
  double share = 1;
  for (int i = 0; i < kShorterSlides; ++i) {
    const double line = 0.9 * share_within(change(base), change(next), allowed);
    share *= std::clamp(line, 0.02, may_follow && i > 1 ? 0.25 : 0.9);
    if (may_follow && i == 1) share = std::min(share, held.travelled / norm(lag(held)));
    next = move(x, held, may_follow ? Shares{.follow = share} : Shares{.follow = 0, .slip = share});
    if (within(next)) return next;
  }
  return base;
}

/// The model after a share of the slide, with an offset that keeps the energy in the budget.
ContactState::Candidate ContactState::move(const Vec3& x, const Held& held,
                                           const Shares& shares) const noexcept {
  std::uint32_t status = 0;
  Candidate next{slide(x, held, shares, status), {}, {}, goal_, 0};
  next.status = status;
  next.deflection = next.model.deflection(x);
  double recovery = shares.recovery;
  if (!(next.deflection.depth > 0)) {
    // Out of normal contact but perhaps inside the body: the offset follows the tip outwards, at no
    // energy, until the true surface is felt again.
    const double rearmed = std::min(next.model.offset(), std::max(next.deflection.geometric, 0.0));
    next.goal = std::min(goal_, rearmed);
    next.model.set_offset(rearmed);
    next.deflection = next.model.deflection(x);
    recovery = 0;
  }
  next.response = next.model.respond(next.deflection, pieces_);
  if (settings_.budget == EnergyBudget::Kept) keep_budget(next, x, held, recovery);
  if (shares.slip == 1) keep_friction(next, held.allowance);
  return next;
}

/// Where no offset keeps a slide in the budget c is held, and the tool slips over it: at the same c
/// that lowers the energy.
void ContactState::keep_budget(Candidate& moved, const Vec3& x, const Held& held,
                               double recovery) const noexcept {
  const EnergyVerdict verdict = judge(moved.model, x, moved.response,
                                      tank_.budget(held.response.energy), moved.goal, recovery);
  if (!verdict.limited && verdict.offset == moved.model.offset()) return;
  if (verdict.limited) moved.status |= PALPATE_ENERGY_LIMITED;
  if (verdict.hold) {
    moved.model = let_go(held, 1);
    moved.goal = goal_;
  } else {
    moved.model.set_offset(verdict.offset);
  }
  respond(moved, x);
}

void ContactState::respond(Candidate& at, const Vec3& x) const noexcept {
  at.deflection = at.model.deflection(x);
  at.response = at.model.respond(at.deflection, pieces_);
}

/// What a slide or a change of the offset has left of the lateral force above mu g is let go at
/// once: all of coupled responses, whose bound holds up to the slip limit. Of decoupled ones, whose
/// bound holds everywhere, what is above that of one step of travel; the next slide of c takes the
/// rest.
void ContactState::keep_friction(Candidate& moved, double allowance) const noexcept {
  if (!exceeds_friction(moved.response, moved.model.coupled() ? 0 : allowance)) return;
  const double limit = slip_limit(moved.model, moved.deflection, moved.response);
  moved.model.slip_to(limit, moved.deflection, moved.response, pieces_);
}

LocalModel ContactState::slide(const Vec3& x, const Held& held, const Shares& shares,
                               std::uint32_t& status) const noexcept {
  if (shares.follow == 0) return let_go(held, shares.slip);
  if (!(held.deflection.depth > 0) && shares.follow == 1) return relax(x, status);
  const bool apart = model_->lateral_offset() != Vec3{};
  if (!apart && !(held.excess > 0)) return *model_;
  return follow(held, shares.follow, apart, status);
}

/// Where the lateral deflection exceeds the slip limit the anchor c + s moves by the excess along
/// t, and c goes a share of the way to it. What c does not go is left in s. Where nothing hinders
/// c, s stays zero: of an ordinary slide the next step takes what the curvature left over.
LocalModel ContactState::follow(const Held& held, double share, bool apart,
                                std::uint32_t& status) const noexcept {
  const Vec3 way = lag(held);
  const double distance = apart ? norm(way) : held.excess;
  const Vec3 direction = apart ? way : held.deflection.tangent;
  const Walk moved = walk(*surface_, model_->point(), direction, share * distance, delivered_);
  if (moved.at_border) status |= PALPATE_AT_BORDER;
  if (moved.awaiting) status |= PALPATE_AWAITING;
  LocalModel next(*surface_, moved.point, model_->offset());
  if (apart || moved.hindered || share != 1) {
    next.set_lateral_offset(way - (next.contact_point() - model_->contact_point()));
    if (share == 1 && norm(next.lateral_offset()) <= kRelaxed) next.set_lateral_offset({});
  }
  return next;
}

/// From c to the anchor once it has slipped.
Vec3 ContactState::lag(const Held& held) const noexcept {
  return model_->lateral_offset() + held.excess * held.deflection.tangent;
}

/// Out of normal contact nothing holds the tool: c follows the tip until x - c is parallel to n,
/// and where it cannot, s does.
LocalModel ContactState::relax(const Vec3& x, std::uint32_t& status) const noexcept {
  const Projection p = project(*surface_, model_->point(), x, kRelaxedPasses, kRelaxed, delivered_);
  if (p.at_border) status |= PALPATE_AT_BORDER;
  if (p.awaiting) status |= PALPATE_AWAITING;
  LocalModel next(*surface_, p.point, model_->offset());
  if (p.lateral > kRelaxed) next.set_lateral_offset(x - next.contact_point());
  return next;
}

/// c held; of the excess over the slip limit a share goes into s.
LocalModel ContactState::let_go(const Held& held, double share) const noexcept {
  LocalModel next = *model_;
  next.set_lateral_offset(model_->lateral_offset() +
                          (share * held.excess) * held.deflection.tangent);
  return next;
}

/// The contact ends when the tip is out of normal contact and outside the body, and the lateral
/// deflection has relaxed: nothing is stored then.
bool ContactState::release(const Candidate& moved, const Vec3& x, double energy_before) noexcept {
  const Deflection& d = moved.deflection;
  const Element& e = surface_->element(moved.model.point().element);
  if (d.depth > 0 || surface_->outside_distance(e, x) < 0) return false;
  if (d.lateral > kRelaxed) return false;  // the force still falls
  if (norm(moved.model.lateral_offset()) > kRelaxed) {
    // The way for c is not there yet; or c is not opposite to the tip, so that its plane does not
    // decide on which side the tip is.
    if (moved.status & PALPATE_AWAITING) return false;
    if (closest_if_inside(x).element != kNoElement) return false;
  }
  tank_.settle(energy_before, 0);
  seen_.status |= PALPATE_RELEASED;
  free_contact();
  return true;
}

void ContactState::commit(const Candidate& next, double energy_before) noexcept {
  const bool same_element = model_ && model_->point().element == next.model.point().element;
  model_ = next.model;
  if (ahead_ != kNoElement || !same_element) look_ahead(next.deflection);
  goal_ = next.goal;
  tank_.settle(energy_before, next.response.energy);
  if (next.deflection.depth > next.model.deepest()) seen_.status |= PALPATE_BEYOND_DEPTH;
  seen_.point = next.model.point();
  seen_.contact_point = next.model.contact_point();
  seen_.normal = next.model.normal();
  seen_.deflection = next.deflection;
  seen_.offset = next.model.offset();
  seen_.lateral_offset = next.model.lateral_offset();
  seen_.energy = next.response.energy;
  seen_.force = next.response.force;
  seen_.tank = tank_.level();
}

/// What the contact point may reach in the next steps is fetched from memory in this one.
void ContactState::look_ahead(const Deflection& at) noexcept {
  const std::int32_t now = model_->point().element;
  const NodeCurves::InUse in_use = model_->curves_in_use(at);
  if (ahead_ != kNoElement) surface_->prefetch_beyond(ahead_, in_use);
  if (ahead_ != now) surface_->prefetch_around(now, in_use);
  ahead_ = ahead_ == now ? kNoElement : now;
}

void ContactState::free_contact() noexcept {
  model_.reset();
  const std::uint32_t status = seen_.status;
  const double absorbed = seen_.absorbed;
  seen_ = {};
  seen_.status = status;
  seen_.absorbed = absorbed;
  seen_.tank = tank_.level();
}

void ContactState::drop() noexcept {
  approaching_.reset();
  if (!model_) return;
  seen_.status |= PALPATE_DROPPED;
  free_contact();
}

}  // namespace palpate::runtime
