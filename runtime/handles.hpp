// SPDX-License-Identifier: Apache-2.0
// What stands behind the opaque handles of palpate.h. For the C interface and for tests that make a
// library in memory; not installed.
#pragma once

#include <cstdint>
#include <optional>

#include "format/library.hpp"
#include "runtime/collision.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/palpate.h"
#include "runtime/pose.hpp"
#include "runtime/search_thread.hpp"
#include "runtime/surface.hpp"

struct palpate_library {
  explicit palpate_library(const palpate::Library& library)
      : surface(library),
        tree(surface),
        info(describe(library, surface)),
        lipschitz_bound(palpate::enforced_lipschitz_bound(library.certificate)),
        min_lipschitz_bound(std::isfinite(info.hold) ? info.hold : info.stick),
        certified(!library.certificate.triangles.empty()) {}
  palpate_library(const palpate_library&) = delete;  // the tree points into the surface
  palpate_library& operator=(const palpate_library&) = delete;

  static palpate_library_info describe(const palpate::Library& library,
                                       const palpate::runtime::Surface& surface);

  palpate::runtime::Surface surface;
  palpate::runtime::CollisionTree tree;
  palpate_library_info info;
  double lipschitz_bound;      ///< N/m, what the change of force is held to unless told otherwise
  double min_lipschitz_bound;  ///< N/m, that a state may be given
  bool certified;
};

struct palpate_state {
  /// search_rate: Hz of the search thread; 0 = the step searches the body itself.
  palpate_state(const palpate_library& library, const palpate::runtime::ContactSettings& settings,
                double search_rate = 0)
      : contact(library.surface, library.tree, settings) {
    if (search_rate <= 0) return;
    search.emplace(library.surface, library.tree, search_rate);
    contact.set_delivery(&delivery);  // nothing yet
  }
  palpate_state(const palpate_state&) = delete;
  palpate_state& operator=(const palpate_state&) = delete;

  /// One step with the tip at x in the world.
  std::uint32_t step(const palpate::Vec3& x) noexcept {
    const palpate::Vec3 in_body = pose.to_body(x);
    if (!search) return contact.step(in_body);
    if (search->receive(delivery)) contact.set_delivery(&delivery);
    const std::uint32_t status = contact.step(in_body);
    if (!(status & PALPATE_BAD_INPUT)) {
      search->report({in_body, contact.observation().point.element});
    }
    return status;
  }
  /// What to command to the device: the force of the body on the tool, in the world, N.
  palpate::Vec3 command() const noexcept {
    const palpate::Vec3& f = contact.observation().force;
    return pose.turn({-f[0], -f[1], -f[2]});
  }
  /// The observation with points and directions in the world.
  palpate::runtime::ContactObservation observe() const noexcept {
    palpate::runtime::ContactObservation seen = contact.observation();
    seen.force = pose.turn(seen.force);
    seen.normal = pose.turn(seen.normal);
    seen.lateral_offset = pose.turn(seen.lateral_offset);
    if (seen.point.element >= 0) seen.contact_point = pose.to_world(seen.contact_point);
    return seen;
  }

  palpate::runtime::ContactState contact;
  palpate::runtime::Pose pose;
  palpate::runtime::Delivery delivery;
  std::optional<palpate::runtime::SearchThread> search;
};
