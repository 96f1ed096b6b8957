// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "fem/quadratic_mesh.hpp"

namespace palpate::fem {

/// Lower triangle of a symmetric matrix, compressed by columns, row indices ascending; the diagonal
/// comes first in each column.
struct SparsePattern {
  int n = 0;
  std::vector<int> start;  ///< (n + 1)
  std::vector<int> row;    ///< (nonzeros)

  int nonzeros() const { return start.empty() ? 0 : start.back(); }

  /// Place of an entry in the array of values; the entry must exist. Rows and columns in any order.
  int position(int i, int j) const;
};

/// Pattern of the stiffness of some elements of a mesh: all unknowns of an element are coupled.
/// `equation`: first of the three unknowns of each node, or -1; `unknowns`: their number.
SparsePattern stiffness_pattern(const QuadraticMesh& mesh, const std::vector<int>& elements,
                                const std::vector<int>& equation, int unknowns);

/// y = A x for a symmetric matrix stored by its lower triangle.
void symmetric_multiply(const SparsePattern& pattern, const std::vector<double>& values,
                        const double* x, double* y);

}  // namespace palpate::fem
