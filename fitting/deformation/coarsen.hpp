// SPDX-License-Identifier: AGPL-3.0-or-later
// A smaller deformation, for pictures of the response surface.
#pragma once

#include <cstddef>
#include <vector>

#include "format/deformation.hpp"

namespace palpate::fitting {

/// The same deformation on the vertices of the library alone, with at most `modes` of the leading
/// modes and the middle one of the lateral depths: drags at the others are like it. `triangles`:
/// the response surface, with the vertices of the library.
Deformation coarsened(const Deformation& fine, const std::vector<Triangle>& triangles,
                      std::size_t modes);

}  // namespace palpate::fitting
