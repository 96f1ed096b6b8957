// SPDX-License-Identifier: Apache-2.0
// One tool on one body that has a pose in the world, with or without a search thread.
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/collision.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/pose.hpp"
#include "runtime/search_thread.hpp"
#include "runtime/status.hpp"
#include "runtime/surface.hpp"
#include "runtime/touch.hpp"

namespace palpate::runtime {

/// A contact state in the frame of the body, seen from the world. step(), command() and observe()
/// are noexcept, allocation-free and bounded. One object belongs to one thread at a time, but for
/// touch(): every step, and every change of the pose, publishes it.
class PosedContact {
 public:
  /// The surface and the tree must outlive the contact. search_rate: Hz of the search thread; 0 =
  /// each step searches the whole body.
  PosedContact(const Surface& surface, const CollisionTree& tree, const ContactSettings& settings,
               double search_rate)
      : contact(surface, tree, settings) {
    if (search_rate <= 0) return;
    search_.emplace(surface, tree, search_rate);
    contact.set_delivery(&delivery_);  // no triangles yet
  }
  PosedContact(const PosedContact&) = delete;
  PosedContact& operator=(const PosedContact&) = delete;

  /// One step with the tip at x in the world, m, dt (s) after the last. @return status bits.
  std::uint32_t step(const Vec3& x, double dt) noexcept {
    const Vec3 in_body = pose.to_body(x);
    if (search_ && search_->receive(delivery_)) contact.set_delivery(&delivery_);
    const std::uint32_t status = contact.step(in_body, dt);
    publish();
    if (search_ && !(status & step_status::BadInput)) {
      search_->report({in_body, contact.observation_but_energies().point.element});
    }
    return status;
  }
  /// No contact with the tip at x in the world, m; see ContactState::suspend. @return status bits.
  std::uint32_t suspend(const Vec3& x) noexcept {
    const Vec3 in_body = pose.to_body(x);
    const std::uint32_t status = contact.suspend(in_body);
    publish();
    if (search_ && !(status & step_status::BadInput)) search_->report({in_body, kNoElement});
    return status;
  }
  /// A step with unusable input; see ContactState::refuse. @return status bits.
  std::uint32_t refuse() noexcept {
    const std::uint32_t status = contact.refuse();
    publish();
    return status;
  }
  /// See ContactState::reset. The pose remains.
  void reset() noexcept {
    contact.reset();
    publish();
  }
  void set_pose(const Pose& now) noexcept {
    pose = now;
    publish();
  }
  /// The contact as it was published last. From any thread.
  Touch touch() const noexcept { return published_.read(); }

  /// The force of the body on the tool, in the world, N: what to command to the device.
  Vec3 command() const noexcept {
    const Vec3& f = contact.observation_but_energies().force;
    return pose.turn({-f[0], -f[1], -f[2]});
  }
  /// The observation with points and directions in the world.
  ContactObservation observe() const noexcept {
    ContactObservation seen = contact.observation();
    seen.force = pose.turn(seen.force);
    seen.normal = pose.turn(seen.normal);
    seen.lateral_offset = pose.turn(seen.lateral_offset);
    if (seen.point.element >= 0) seen.contact_point = pose.to_world(seen.contact_point);
    return seen;
  }
  /// The triangles that the search thread delivered last; without a search thread none.
  const Delivery& delivery() const noexcept { return delivery_; }

  ContactState contact;
  Pose pose;

 private:
  void publish() noexcept {
    const ContactObservation& seen = contact.observation_but_energies();
    Touch touch;
    touch.pose = pose;
    if (seen.point.element >= 0 && (seen.status & step_status::Contact) != 0) {
      touch.point = seen.point;
      touch.contact_point = seen.contact_point;
      touch.normal = seen.normal;
      touch.depth = seen.deflection.depth + seen.offset;
      touch.lateral = seen.lateral_displacement;
      touch.shear = seen.shear;
      touch.tip =
          seen.contact_point + touch.depth * seen.normal + touch.lateral + seen.lateral_offset;
    }
    published_.publish(touch);
  }

  PublishedTouch published_;
  Delivery delivery_;
  std::optional<SearchThread> search_;
};

}  // namespace palpate::runtime
