// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/line_of_touch.hpp"

#include <cmath>
#include <numbers>

#include "format/library.hpp"

namespace palpate::app::slingshot {
namespace {

constexpr double kRadius = 0.04;          // m
constexpr double kLength = 0.2;           // m
constexpr int kAround = 25, kAlong = 20;  // patches of 10 mm

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
  body_ = std::make_unique<palpate_library>(cylinder(k));
  contact_.emplace(body_->surface, body_->tree, runtime::ContactSettings{setup.friction, kTankCap});
  entry_ = std::sqrt(kRadius * kRadius - setup.off_axis * setup.off_axis);
  if (setup.search_rate <= 0) return;
  const auto period = static_cast<int>(std::lround(setup.rate / setup.search_rate));
  search_ = std::make_unique<runtime::LockstepSearch>(body_->surface, body_->tree, period);
}

double LineOfTouch::force(double depth) {
  if (!contact_) return wall_force(k_, depth);
  const Vec3 tip{entry_ - depth, setup_.off_axis, kLength / 2};
  if (search_) {
    search_->step(*contact_, tip);
  } else {
    contact_->step(tip);
  }
  return -contact_->observation().force[0];
}

}  // namespace palpate::app::slingshot
