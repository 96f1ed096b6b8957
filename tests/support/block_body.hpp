// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies for tests, made without the mesher: blocks of tetrahedra on a (graded) grid.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "format/body.hpp"

namespace palpate::test {

/// A block spanned by three ascending lists of coordinates, six tetrahedra a cell (Kuhn). The base
/// z = z.front() is fixed; the response surface is the top with every grid vertex a response node,
/// rim vertices excluded from the sites. One region, "tissue".
Body make_block(const std::vector<double>& x, const std::vector<double>& y,
                const std::vector<double>& z);

/// `count` intervals from `low` to `high`, evenly spaced.
std::vector<double> even(double low, double high, int count);

/// Coordinates from -half to half, symmetric, with cells of `fine` within |x| <= core that grow
/// outwards by `growth`, fitted to end at `half`.
std::vector<double> graded(double half, double core, double fine, double growth);

/// The unit cube in 2 x 2 x 2 cells with its inner node displaced; nothing is fixed.
Body uneven_cube();

/// A block with these coordinates across and the lower half of them down: twice as wide as high,
/// and fine at the middle of its top.
Body graded_block(double half, double core, double fine, double growth);

/// The site nearest to the vertical line through (x, y); -1 without any.
std::int32_t site_nearest(const Body& body, double x = 0, double y = 0);

/// The facets that belong to one tetrahedron only, outward.
std::vector<Triangle> boundary_of(const std::vector<Tetrahedron>& tetrahedra);

/// Moves every node by a map; the topology stays.
void deform(Body& body, const std::function<Vec3(const Vec3&)>& map);

}  // namespace palpate::test
