// SPDX-License-Identifier: AGPL-3.0-or-later
// Surfaces of the regions inside a body, which the picture outlines.
#pragma once

#include <cstdint>
#include <vector>

#include "format/body.hpp"

namespace palpate::report {

/// The closed surface of a region.
struct Inclusion {
  std::int32_t region = 0;         ///< index into Body::region_names
  std::vector<std::int32_t> node;  ///< (P) index into Body::nodes
  std::vector<Triangle> facets;    ///< indices into `node`, oriented outwards
};

/// The regions without a node on the boundary of the body, in the order of their names.
std::vector<Inclusion> inclusions(const Body& body);

}  // namespace palpate::report
