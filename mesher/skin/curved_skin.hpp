// SPDX-License-Identifier: AGPL-3.0-or-later
// A curved skin on elements with flat sides.
#pragma once

#include "format/body.hpp"

namespace palpate::mesher {

/// Halves the bulge of the curved edges of an element until every part that the element is divided
/// into at the middles of its edges has at least a third of its volume under straight edges. After
/// six halvings an edge is straight and leaves Body::curved_edges.
/// An element that is degenerate under straight edges stays as it is: check_elements refuses it.
/// @return the number of edges whose bulge was reduced
std::size_t reduce_bulges(Body& body);

}  // namespace palpate::mesher
