// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/posed_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include "runtime/handles.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::PosedContact;

TEST(PosedContact, CommandsAndObservesInTheWorld) {
  // A plate in z = 0 turned so that its outward normal +z becomes +x of the world.
  const palpate_library body(plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  PosedContact contact(body.surface, body.tree, {0.3, 5e-3}, 0);
  contact.pose = {{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}}, {1, 2, 3}};
  const auto at = [](double height) { return Vec3{1 + height, 2 + 0.033, 3 + 0.031}; };
  contact.step(at(1e-4), 1e-3);
  std::uint32_t status = 0;
  for (int i = 1; i <= 40; ++i) status = contact.step(at(-1e-4 * i), 1e-3);
  EXPECT_TRUE(status & runtime::step_status::Contact);
  const double z = 4e-3 - 1e-4;
  EXPECT_NEAR(norm(contact.command() - Vec3{100 * 170 * z * z, 0, 0}), 0, 1e-6);
  const auto seen = contact.observe();
  EXPECT_NEAR(norm(seen.contact_point - at(0)), 0, 1e-12);
  EXPECT_NEAR(norm(seen.normal - Vec3{-1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(norm(seen.force + contact.command()), 0, 1e-15);
}

TEST(PosedContact, WithASearchThreadMeetsNothingBeforeTheFirstDelivery) {
  const palpate_library body(plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  PosedContact contact(body.surface, body.tree, {0.3, 5e-3}, 1e-3);  // once in 1000 s
  for (int i = 0; i < 20; ++i) contact.step({0.033, 0.031, 5e-4 - 1e-4 * i}, 1e-3);
  EXPECT_EQ(norm(contact.command()), 0);
}

/// The rotation followed by a turn of `angle` (rad) about the unit `axis`.
std::array<Vec3, 3> turned(const std::array<Vec3, 3>& rotation, const Vec3& axis, double angle) {
  std::array<Vec3, 3> result{};
  for (std::size_t j = 0; j < 3; ++j) {
    const Vec3 v{rotation[0][j], rotation[1][j], rotation[2][j]};
    const Vec3 w = std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
                   ((1 - std::cos(angle)) * dot(axis, v)) * axis;
    for (std::size_t i = 0; i < 3; ++i) result[i][j] = w[i];
  }
  return result;
}

/// A tip that trembles in a body which turns about it, by microradians up to a radian a step, and
/// sometimes shifts: whatever the command, the force follows in bounded steps.
class Turning {
 public:
  Turning(const palpate_library& body, double bound)
      : contact(body.surface, body.tree, {.friction = 0.3, .lipschitz_bound = bound}, 0),
        bound_(bound) {}

  void touch(double depth) {
    contact.pose = {};
    for (const double height : {2e-3, -depth / 2, -depth}) {
      in_body_ = {0.03 + height, 1e-3, 2e-3};
      contact.step(in_body_, 1e-3);
    }
  }
  /// @return change of the force over its bound, L (path in the body + angle times arm) (R15a).
  double step() {
    const runtime::ContactObservation was = contact.contact.observation();
    const Vec3 before = contact.command();
    const double angle = std::pow(10, between(-6, 0));
    const double size = moves_++ % 2 == 0 ? 0 : std::pow(10, between(-8, -4));
    const double arm = norm(in_body_ - was.contact_point - was.lateral_offset) + force_free(was);
    const Vec3 target = in_body_ + size * unit();
    runtime::Pose& pose = contact.pose;
    const Vec3 tip = pose.to_world(in_body_);
    pose.rotation = turned(pose.rotation, unit(), angle);
    pose.position = tip - pose.turn(target);  // brings `target` to the tip, which rests
    contact.step(tip, 1e-3);
    in_body_ = target;
    return norm(contact.command() - before) / (bound_ * (size + angle * arm) + 1e-9);
  }

  runtime::PosedContact contact;

 private:
  /// How far from the anchor, across n, the force is zero: |d0 sigma| + |e - sigma z_w/2|, m.
  static double force_free(const runtime::ContactObservation& seen) {
    const double half = 0.5 * seen.grip.depth, sheared = seen.deflection.depth - half;
    const Vec3 lean = sheared > 0 ? (1 / sheared) * seen.shear : Vec3{};
    return std::abs(seen.offset) * norm(lean) + norm(seen.grip.micro_slip - half * lean);
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 unit() {
    std::normal_distribution<double> any;
    const Vec3 v{any(random_), any(random_), any(random_)};
    return (1 / norm(v)) * v;
  }

  double bound_;  // N/m
  std::mt19937 random_{11};
  Vec3 in_body_{};
  int moves_ = 0;
};

/// @param bound  N/m, L_min of the certificate of the body at mu = 0.3
void expect_turns_like_motions(const Library& library, double bound) {
  const palpate_library body(library);
  Turning tool(body, bound);
  double largest_force = 0, largest_ratio = 0;
  for (int touch = 0; touch < 40; ++touch) {
    tool.touch(1e-3 + 1e-4 * touch);
    for (int i = 0; i < 100; ++i) {
      largest_ratio = std::max(largest_ratio, tool.step());
      largest_force = std::max(largest_force, norm(tool.contact.command()));
    }
  }
  EXPECT_GT(largest_force, 0.1);
  EXPECT_GT(largest_ratio, 0.3);
  EXPECT_LE(largest_ratio, 1);
}

TEST(PosedContact, ARotationOfTheBodyChangesTheForceAsAMotionDoes) {
  const Library walls =
      bumpy_sphere(3, 0.03, 0.1, [](const Vec3&) { return wall_response(170, 120); });
  {
    SCOPED_TRACE("walls");
    expect_turns_like_motions(walls, 178);
  }
  {
    SCOPED_TRACE("leaning");
    expect_turns_like_motions(leaning(walls, 0.3), 205);
  }
  {
    SCOPED_TRACE("leaning with the contact");
    expect_turns_like_motions(leaning(coupled(walls), 0.3), 287);
  }
}

}  // namespace
}  // namespace palpate::test
