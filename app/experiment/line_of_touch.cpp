// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/line_of_touch.hpp"

#include <cmath>
#include <numbers>

#include "format/library.hpp"

namespace palpate::app::slingshot {
namespace {

// The paper counts about 500 patches and gives neither radius nor length.
constexpr int kAround = 18, kAlong = 14;                                       // 504 triangles
constexpr double kRadius = 0.04;                                               // m
constexpr double kLength = kAlong * 2 * std::numbers::pi * kRadius / kAround;  // m

/// Both responses are (35), as the normal one in the paper, which names no other.
NodeResponse response_of(double k) {
  const auto slope = static_cast<float>(k);
  NodeResponse r;
  r.status = ResponseStatus::Fitted;
  r.normal = {{0.0F, static_cast<float>(kCurved), 0.02F}, {0.0F, slope, slope}};
  r.lateral = r.normal;
  return r;
}

Library cylinder(double k) {
  Library library;
  library.name = "cylinder";
  for (int j = 0; j <= kAlong; ++j) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      const Vec3 out{std::cos(angle), std::sin(angle), 0};
      library.positions.push_back(kRadius * out + Vec3{0, 0, kLength * j / kAlong});
      library.inward.push_back(-out);
      library.responses.push_back(response_of(k));
    }
  }
  for (int j = 0; j < kAlong; ++j) {
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i;
      const int b = j * kAround + (i + 1) % kAround;
      library.triangles.push_back({a, b, b + kAround});
      library.triangles.push_back({a, b + kAround, a + kAround});
    }
  }
  return library;
}

}  // namespace

double wall_force(double k, double x) {
  if (x <= 0) return 0;
  return x < kCurved ? 100 * k * x * x : k * (x - kCurved / 2);
}

LineOfTouch::LineOfTouch(const SlingshotSetup& setup, double k) : setup_(setup), k_(k) {
  if (setup.body == VirtualBody::Wall) return;
  constexpr double kTankCap = 5e-3;  // J
  runtime::ContactSettings settings{setup.friction, kTankCap};
  if (setup.bounded) settings.lipschitz_bound = k;
  body_ = std::make_unique<palpate_library>(cylinder(k));
  contact_.emplace(body_->surface, body_->tree, settings);
  entry_ = std::sqrt(kRadius * kRadius - setup.off_axis * setup.off_axis);
  if (setup.search_rate <= 0) return;
  if (setup.real_time) {
    thread_ =
        std::make_unique<runtime::SearchThread>(body_->surface, body_->tree, setup.search_rate);
    contact_->set_delivery(&delivered_);
    return;
  }
  const auto period = static_cast<int>(std::lround(setup.rate / setup.search_rate));
  search_ = std::make_unique<runtime::LockstepSearch>(body_->surface, body_->tree, period);
}

Vec3 LineOfTouch::tip(double depth) const {
  return {entry_ - depth, setup_.off_axis, kLength / 2};
}

const palpate_library* LineOfTouch::body() const {
  return body_.get();
}

const runtime::ContactObservation& LineOfTouch::seen() const {
  return contact_->observation();
}

double LineOfTouch::force(double depth) {
  if (!contact_) return wall_force(k_, depth);
  if (search_) {
    search_->step(*contact_, tip(depth));
  } else {
    if (thread_ && thread_->receive(delivered_)) contact_->set_delivery(&delivered_);
    contact_->step(tip(depth));
    if (thread_) thread_->report({tip(depth), seen().point.element});
  }
  return -seen().force[0];
}

}  // namespace palpate::app::slingshot
