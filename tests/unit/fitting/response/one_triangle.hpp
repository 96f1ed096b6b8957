// SPDX-License-Identifier: AGPL-3.0-or-later
// A body whose response surface is one triangle, pressed along -z.
#pragma once

#include "format/body.hpp"

namespace palpate::fitting {

inline Body one_triangle() {
  constexpr Vec3 kInto{0, 0, -1};
  Body body;
  body.name = "triangle";
  body.nodes = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}};
  body.response.node = {0, 1, 2};
  body.response.inward = {kInto, kInto, kInto};
  body.response.is_site = {1, 1, 1};
  body.response.triangles = {{0, 1, 2}};
  return body;
}

}  // namespace palpate::fitting
