// SPDX-License-Identifier: Apache-2.0
// What stands behind the opaque handles of palpate.h. For the C interface and for tests that make a
// library in memory; not installed.
#pragma once

#include "format/library.hpp"
#include "runtime/collision.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/palpate.h"
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
  palpate_state(const palpate_library& library, const palpate::runtime::ContactSettings& settings)
      : contact(library.surface, library.tree, settings) {}

  palpate::runtime::ContactState contact;
};
