// SPDX-License-Identifier: AGPL-3.0-or-later
// Where the skin of the body lies beside the flat triangles that carry the responses.
#pragma once

#include <vector>

#include "fitting/fidelity/held_out.hpp"
#include "format/body.hpp"

namespace palpate::fidelity {

/// How far the skin, the boundary of the body, is from a point of the response surface along the
/// unit direction `inward`, m: negative where it bulges out over the triangle, positive where it
/// lies below. Of several places the nearest at which the line enters the body. @throws
/// Error(Geometry) when the line enters it nowhere.
double skin_beside(const Body& body, const Vec3& position, const Vec3& inward);

/// Sets HeldOutPoint::skin of the points that are at no node. @return how far the skin is from
/// them, m, ascending. @throws as skin_beside.
std::vector<double> find_skin(const Body& body, std::vector<HeldOutPoint>& points);

}  // namespace palpate::fidelity
