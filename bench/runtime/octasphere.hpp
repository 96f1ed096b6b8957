// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "format/library.hpp"

namespace palpate::bench {

constexpr double kOctasphereRadius = 0.05;  ///< m

/// Octahedron of that radius with each face divided into n x n triangles, vertices on the sphere:
/// 8 n^2 triangles. Every vertex has responses of 8 knots of its own, stiffness 100 to 300 N/m;
/// coupled ones a weight of 5 knots besides.
Library octasphere(int n, ResponseKind kind = ResponseKind::Decoupled);

}  // namespace palpate::bench
