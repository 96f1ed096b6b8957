// SPDX-License-Identifier: AGPL-3.0-or-later
// Fibres along the gradient of a potential between two parts of the surface.
#pragma once

#include <string>

#include "fem/laws/fibre_field.hpp"
#include "format/body.hpp"

namespace palpate::fem {

/// The field of a region with Kind::Laplace, as samples at the centroids of its elements: the
/// potential phi with Laplacian zero, phi = 0 on the surface nodes of the region in `from`, 1 in
/// `to`, without flux through the rest of its surface, on linear tetrahedra; the mean direction is
/// grad phi. Elements where phi is constant (all nodes in one of the boxes) get no sample and take
/// the direction of the nearest one.
/// @throws Error(Configuration) when a box contains no surface node of the region, the boxes
/// overlap on the surface, or a part of the region is connected to neither.
FibreField fibres_of_potential(const Body& body, std::int32_t region, const FibreField& field,
                               const std::string& where);

}  // namespace palpate::fem
