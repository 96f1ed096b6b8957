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
constexpr int kShorterSlides = 4;       // tries, before the contact point is held

bool finite(const Vec3& v) noexcept {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
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
  const Deflection d = model.deflection(x);
  commit({model, d, model.respond(d), depth, 0}, 0);
  return true;
}

void ContactState::touch(const Vec3& x, double travelled) noexcept {
  Candidate held{*model_, model_->deflection(x), {}, goal_, 0};
  held.response = model_->respond(held.deflection);
  const double energy_before = held.response.energy;  // E_{i-1}(x_i)
  seen_.absorbed += energy_before - seen_.energy;
  const Candidate next = choose(x, held, travelled);
  seen_.status |= next.status;
  if (release(next, x, energy_before)) return;
  if (norm(next.model.contact_point() - model_->contact_point()) > 0) {
    seen_.status |= PALPATE_SLIDING;
  }
  commit(next, energy_before);
}

/// The slide and the return of the offset as far as the force may change in this step. To hold the
/// contact point is always within the limit.
ContactState::Candidate ContactState::choose(const Vec3& x, const Candidate& held,
                                             double travelled) const noexcept {
  const double allowed = std::isinf(settings_.steepness)
                             ? settings_.steepness
                             : settings_.steepness * travelled + kRounding;
  const auto within = [&](const Candidate& c) {
    return norm(c.response.force - seen_.force) <= allowed;
  };
  Candidate next = move(x, held, 1, kRecoveryShare * travelled);
  if (within(next)) return next;
  next = move(x, held, 1, 0);
  double share = 1;
  for (int i = 0; i < kShorterSlides && !within(next); ++i) {
    const double excess = norm(next.response.force - seen_.force) / allowed;
    share *= std::clamp(0.9 / excess, 0.02, 0.7);
    next = move(x, held, share, 0);
  }
  if (!within(next)) next = held;
  next.status |= PALPATE_FORCE_LIMITED;
  return next;
}

/// The model after a share of the slide, with an offset that keeps the energy in the budget.
ContactState::Candidate ContactState::move(const Vec3& x, const Candidate& held, double share,
                                           double recovery) const noexcept {
  Candidate next = held;
  next.model = slide(x, held, share, next.status);
  next.deflection = next.model.deflection(x);
  if (!(next.deflection.depth > 0)) {
    // Out of normal contact but perhaps inside the body: the offset follows the tip outwards, at no
    // energy, until the true surface is felt again.
    const double rearmed = std::min(next.model.offset(), std::max(next.deflection.geometric, 0.0));
    next.goal = std::min(goal_, rearmed);
    next.model.set_offset(rearmed);
    next.deflection = next.model.deflection(x);
    recovery = 0;
  }
  next.response = next.model.respond(next.deflection);
  if (settings_.budget == EnergyBudget::Kept) keep_budget(next, x, held, recovery);
  return next;
}

void ContactState::keep_budget(Candidate& moved, const Vec3& x, const Candidate& held,
                               double recovery) const noexcept {
  const EnergyVerdict verdict = judge(moved.model, x, moved.response,
                                      tank_.budget(held.response.energy), moved.goal, recovery);
  const std::uint32_t status =
      moved.status | (verdict.limited ? std::uint32_t{PALPATE_ENERGY_LIMITED} : 0);
  if (verdict.hold) {
    moved = held;
  } else if (verdict.offset != moved.model.offset()) {
    moved.model.set_offset(verdict.offset);
    moved.deflection = moved.model.deflection(x);
    moved.response = moved.model.respond(moved.deflection);
  }
  moved.status = status;
}

/// Where the lateral deflection exceeds the slip limit, c moves by the excess, or a share of it.
/// Out of normal contact the limit is 0: c follows the tip until x - c is parallel to n.
LocalModel ContactState::slide(const Vec3& x, const Candidate& held, double share,
                               std::uint32_t& status) const noexcept {
  const Deflection& d = held.deflection;
  if (!(d.depth > 0) && share == 1) {
    const Projection p =
        project(*surface_, model_->point(), x, kRelaxedPasses, kRelaxed, delivered_);
    if (p.at_border) status |= PALPATE_AT_BORDER;
    if (p.awaiting) status |= PALPATE_AWAITING;
    return {*surface_, p.point, model_->offset()};
  }
  const LocalResponse& at = held.response;
  if (!(at.lateral_force > settings_.friction * at.grip)) return *model_;
  const double excess = d.lateral - model_->slip_limit_below(d, at, settings_.friction);
  if (!(excess > 0)) return *model_;
  const Walk moved = walk(*surface_, model_->point(), d.tangent, share * excess, delivered_);
  if (moved.at_border) status |= PALPATE_AT_BORDER;
  if (moved.awaiting) status |= PALPATE_AWAITING;
  return {*surface_, moved.point, model_->offset()};
}

/// The contact ends when the tip is out of normal contact and outside the body. What a border kept
/// from relaxing is discarded, not credited to the tank.
bool ContactState::release(const Candidate& moved, const Vec3& x, double energy_before) noexcept {
  const Deflection& d = moved.deflection;
  const Element& e = surface_->element(moved.model.point().element);
  if (d.depth > 0 || surface_->outside_distance(e, x) < 0) return false;
  if (d.lateral > kRelaxed) {
    // The lateral force still has to fall as the tip goes on, or the way for c is not there yet; or
    // c is not opposite to the tip, so that its plane does not decide on which side the tip is.
    if (moved.status & (PALPATE_FORCE_LIMITED | PALPATE_AWAITING)) return false;
    if (closest_if_inside(x).element != kNoElement) return false;
    seen_.status |= PALPATE_DROPPED;
  } else {
    tank_.settle(energy_before, 0);
  }
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
