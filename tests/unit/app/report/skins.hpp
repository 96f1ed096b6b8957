// SPDX-License-Identifier: AGPL-3.0-or-later
// The lump with a skin that deforms, and a session that the runtime rendered on it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "format/body.hpp"
#include "format/library.hpp"
#include "format/recording.hpp"
#include "runtime/palpate.h"

namespace palpate::testing {

/// Bytes of a deformation.pdef for the boundary of a body.
std::string deformation_bytes(const Body& body, const Library& library);

/// The same for its response surface.
std::string surface_deformation_bytes(const Body& body, const Library& library);

/// The C interface on a library and its skin.
class TouchedSkin {
 public:
  TouchedSkin(const Body& body, const Library& library);
  ~TouchedSkin();
  TouchedSkin(const TouchedSkin&) = delete;
  TouchedSkin& operator=(const TouchedSkin&) = delete;

  void step(const Vec3& position, double force[3]);  ///< of 1 ms
  palpate_observation seen() const;
  std::vector<Vec3> deformed() const;

 private:
  palpate_library* library_ = nullptr;
  palpate_state* state_ = nullptr;
  palpate_deformation* skin_ = nullptr;
  std::size_t vertices_ = 0;
};

/// The same motion, with the contact and the forces of the runtime.
Recording rendered(Recording recording, TouchedSkin& skin);

}  // namespace palpate::testing
