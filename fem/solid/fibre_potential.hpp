// SPDX-License-Identifier: AGPL-3.0-or-later
// Fibres along the gradient of a potential that two parts of the surface span.
#pragma once

#include <string>

#include "fem/laws/fibre_field.hpp"
#include "format/body.hpp"

namespace palpate::fem {

/// The field of a region with Kind::Laplace, as samples at the centroids of its elements: the
/// potential phi with Laplacian zero, phi = 0 on the surface nodes of the region in `from`, 1 in
/// `to`, without flux through the rest of its surface, on linear tetrahedra; the mean direction is
/// grad phi. Elements where phi is flat (all their nodes in one of the boxes) have none of their
/// own: the nearest speaks for them.
/// @throws Error(Configuration) where a box holds no surface node of the region, both hold the
/// same, or a part of the region is reached from neither.
FibreField fibres_of_potential(const Body& body, std::int32_t region, const FibreField& field,
                               const std::string& where);

}  // namespace palpate::fem
