// SPDX-License-Identifier: Apache-2.0
#include "runtime/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "format/numbers.hpp"

namespace palpate::runtime {
namespace {

constexpr int kReductions = 8;        // of the memories in one slide before they are lost
constexpr double kBelow = 1 - 1e-12;  // a reduction ends below its goal in spite of rounding
constexpr NormalMemory kFresh{Pair{0, 0}, Pair{0, 0}};

/// A force that was reached before is reached again, in spite of rounding. G* is the largest F z -
/// G, so that this changes it by less than its own rounding.
constexpr double kReachable = 1 - 1e-12;

}  // namespace

/// F after the memories are multiplied by a factor.
double Relaxation::sum_of_forces(const Lanes& fractions, double factor) const noexcept {
  double relaxed = 0;
  for (std::size_t p = 0; p < pairs_of(times_); ++p)
    relaxed = plus(relaxed, fractions.pair[p] * (factor * memory_.pair[p]));
  return relaxed;
}

/// relaxed: F. Infinite where a force is beyond every depth of the response. The lane after those
/// of the branches is that of the skin.
inline NormalMemory Relaxation::sums(const InterpolatedResponse& response, const Lanes& fractions,
                                     double factor, double relaxed) const noexcept {
  double stored = 0;
  const auto conjugate_of = [&](std::size_t p, const Pair& force) {
    const Pair conjugate = pieces_.reach(p, kReachable * force).conjugate(force);
    const Pair& fraction = fractions.pair[p];
    stored = plus(stored, fraction > Pair{} ? fraction * conjugate : Pair{});
    return conjugate;
  };
  pieces_.keep_for(response.nodes(), response.natural());
  const std::size_t last = times_ / 2;
  for (std::size_t p = 0; p < last; ++p) conjugate_of(p, factor * memory_.pair[p]);
  const double beside_skin = times_ % 2 == 1 ? factor * memory_[times_ - 1] : relaxed;
  const double skin = conjugate_of(last, Pair{beside_skin, relaxed})[1];
  const double locked = stored < kInfinity ? std::max(stored - skin, 0.0) : kInfinity;
  return {Pair{relaxed, factor}, Pair{stored, locked}};
}

NormalMemory Relaxation::normal_carried_to(const InterpolatedResponse& response,
                                           const Lanes& fractions, double factor) const noexcept {
  if (!remembers()) return kFresh;
  for (int i = 0; i < kReductions; ++i) {
    const NormalMemory there = sums(response, fractions, factor, sum_of_forces(fractions, factor));
    if (there.locked() <= now_.locked()) return there;
    // R of a power law f ~ z^n falls as factor^((n + 1)/n): this is enough for each.
    factor *= kBelow * now_.locked() / there.locked();
  }
  return kFresh;
}

TissueMemory Relaxation::carried_to(const ContactPlace& place, double distance,
                                    Shear shear) const noexcept {
  const LateralMemory& lateral = lateral_.now();
  const bool shears = lateral.any && shear == Shear::Kept;
  if (distance == 0) return {now_, shears ? lateral : LateralMemory{}};
  if (!remembers() && !shears) return {kFresh, {}};
  if (!surface_->relaxes_alike() && !(place.point == considered_)) {
    considered_ = place.point;
    there_ = surface_->fractions(place.point);
  }
  const Lanes& fractions = surface_->relaxes_alike() ? fractions_ : there_;
  const double factor = std::exp(-distance * surface_->inverse_tool_radius());
  // The lateral memory first, as the force waits longest for it.
  TissueMemory there;
  if (shears)
    there.lateral =
        lateral_.carried_to({place.response, fractions, place.normal, place.weights}, factor);
  there.normal = normal_carried_to(place.response, fractions, factor);
  return there;
}

LateralMemory Relaxation::held_at(const ContactPlace& place,
                                  const LateralMemory& memory) const noexcept {
  const bool here = surface_->relaxes_alike() || memory.slide == 0;
  return lateral_.held_at({place.response, here ? fractions_ : there_, place.normal, place.weights},
                          memory);
}

void Relaxation::carry(const ContactPlace& place, const TissueMemory& changed,
                       const Vec3& slid) noexcept {
  if (changed.normal.carried() != 1)
    for (std::size_t k = 0; k < pairs_of(times_); ++k) memory_.pair[k] *= changed.normal.carried();
  if (!surface_->relaxes_alike() || !response_)
    fractions_ = place.point == considered_ ? there_ : surface_->fractions(place.point);
  response_ = place.response;
  normal_ = place.normal;
  weights_ = place.weights;
  now_ = changed.normal;
  now_.relaxed_and_carried = Pair{now_.relaxed(), 1};
  if (lateral_.now().any) lateral_.carry(here(), changed.lateral, slid);
}

void Relaxation::keep_decay(double dt) noexcept {
  if (dt == decay_dt_) return;
  decay_dt_ = dt;
  const auto& times = surface_->relaxation_times();
  for (std::size_t i = 0; i < times_; ++i) decay_.set(i, std::exp(-dt / times[i]));
  decay_.set(times_, decay_[times_ - 1]);
}

void Relaxation::pass(double g, double dt) noexcept {
  if (!response_) return;
  keep_decay(dt);
  const double target = std::max(g, now_.relaxed());
  for (std::size_t p = 0; p < pairs_of(times_); ++p)
    memory_.pair[p] = target + (memory_.pair[p] - target) * decay_.pair[p];
  now_ = {Pair{sum_of_forces(fractions_, 1), 1}, Pair{}};
  normal_found_ = lateral_found_ = false;
}

void Relaxation::find_normal() noexcept {
  if (normal_found_ || !response_) return;
  stored_and_locked_ = sums(*response_, fractions_, 1, now_.relaxed()).stored_and_locked;
  normal_found_ = true;
}

void Relaxation::find() noexcept {
  find_normal();
  if (lateral_found_ || !response_) return;
  lateral_stored_ = lateral_.find_stored(here());
  lateral_found_ = true;
}

double Relaxation::find_stored(bool lags) noexcept {
  find();
  return stored_and_locked_[lags ? 1 : 0] + lateral_stored_;
}

void Relaxation::settle() noexcept {
  if (!response_) return;
  find();
  now_.stored_and_locked = stored_and_locked_;
  lateral_.settle(lateral_stored_);
}

void Relaxation::pass_lateral(const Vec3& force, double lateral) noexcept {
  if (response_) lateral_.pass(here(), force, lateral, decay_);
}

void Relaxation::forget() noexcept {
  memory_ = {};
  now_ = {};
  normal_found_ = lateral_found_ = false;
  lateral_.forget();
}

}  // namespace palpate::runtime
