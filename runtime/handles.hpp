// SPDX-License-Identifier: Apache-2.0
// The structs behind the opaque handles of palpate.h: for the C interface, and for programs that
// make a library in memory. Not installed.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "format/guarantee.hpp"
#include "format/library.hpp"
#include "runtime/collision.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/palpate.h"
#include "runtime/posed_contact.hpp"
#include "runtime/surface.hpp"

struct palpate_library {
  explicit palpate_library(const palpate::Library& library)
      : positions(library.positions),
        inward(library.inward),
        triangles(library.triangles),
        statuses(statuses_of(library)),
        surface(library),
        tree(surface),
        info(describe(library, surface)),
        lipschitz_bound(palpate::enforced_lipschitz_bound(library.certificate)),
        min_lipschitz_bound(std::isfinite(info.min_lipschitz_bound) ? info.min_lipschitz_bound
                                                                    : info.stick),
        certified_range(palpate::certified_range(library)),
        certified(!library.certificate.triangles.empty()) {}
  palpate_library(const palpate_library&) = delete;  // the tree points into the surface
  palpate_library& operator=(const palpate_library&) = delete;

  static palpate_library_info describe(const palpate::Library& library,
                                       const palpate::runtime::Surface& surface);

  static std::vector<std::uint8_t> statuses_of(const palpate::Library& library) {
    std::vector<std::uint8_t> statuses;
    for (const palpate::NodeResponse& response : library.responses)
      statuses.push_back(static_cast<std::uint8_t>(response.status));
    return statuses;
  }

  // As in the file: the surface has them in an order of its own.
  std::vector<palpate::Vec3> positions, inward;
  std::vector<palpate::Triangle> triangles;
  std::vector<std::uint8_t> statuses;
  palpate::runtime::Surface surface;
  palpate::runtime::CollisionTree tree;
  palpate_library_info info;
  double lipschitz_bound;      ///< N/m, enforced by default
  double min_lipschitz_bound;  ///< N/m, smallest setting of a state
  palpate::CertifiedRange certified_range;
  bool certified;
};

struct palpate_state : palpate::runtime::PosedContact {
  palpate_state(const palpate_library& library, const palpate::runtime::ContactSettings& settings,
                double search_rate = 0)
      : PosedContact(library.surface, library.tree, settings, search_rate),
        made_with(&library),
        certified_range(library.certified_range),
        friction(settings.friction),
        lipschitz_bound(settings.lipschitz_bound) {}

  const palpate_library* made_with;
  // Of the library and the settings, for certification.
  palpate::CertifiedRange certified_range;
  double friction, lipschitz_bound;
  std::atomic<bool> in_loop{false};  ///< from the start of a loop until it is stopped
};
