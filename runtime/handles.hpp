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
#include "runtime/search_thread.hpp"
#include "runtime/surface.hpp"

struct palpate_library {
  explicit palpate_library(const palpate::Library& library)
      : surface(library),
        tree(surface),
        info(describe(library, surface)),
        steepness(limit_of(library)),
        certified(!library.certificate.triangles.empty()) {}
  palpate_library(const palpate_library&) = delete;  // the tree points into the surface
  palpate_library& operator=(const palpate_library&) = delete;

  static palpate_library_info describe(const palpate::Library& library,
                                       const palpate::runtime::Surface& surface);

  /// What the change of force is held to, N/m: the certified bound, at most 4 L_stick (a slide can
  /// be unbounded, and follows well enough below that); none without a certificate.
  static double limit_of(const palpate::Library& library);

  palpate::runtime::Surface surface;
  palpate::runtime::CollisionTree tree;
  palpate_library_info info;
  double steepness;
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

  std::uint32_t step(const palpate::Vec3& x) noexcept {
    if (!search) return contact.step(x);
    if (search->receive(delivery)) contact.set_delivery(&delivery);
    const std::uint32_t status = contact.step(x);
    if (!(status & PALPATE_BAD_INPUT)) search->report({x, contact.observation().point.element});
    return status;
  }

  palpate::runtime::ContactState contact;
  palpate::runtime::Delivery delivery;
  std::optional<palpate::runtime::SearchThread> search;
};
