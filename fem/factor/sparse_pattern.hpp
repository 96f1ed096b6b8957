// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace palpate::fem {

/// Lower triangle of a symmetric matrix, compressed by columns, row indices ascending; the diagonal
/// comes first in each column.
struct SparsePattern {
  int n = 0;
  std::vector<int> start;  ///< (n + 1)
  std::vector<int> row;    ///< (nonzeros)

  int nonzeros() const { return start.empty() ? 0 : start.back(); }

  /// Index of an entry in the array of values; the entry must exist. Row and column in any order.
  int position(int i, int j) const;
};

/// Pattern of a stiffness that couples all unknowns within each group of nodes: the nodes of an
/// element, or all on which a pressure acts. `equation`: first of the three unknowns of each node,
/// or -1; `unknowns`: their number.
SparsePattern stiffness_pattern(const std::vector<std::span<const std::int32_t>>& groups,
                                const std::vector<int>& equation, int unknowns);

/// values += scale g g^T, g given on three unknowns of each of some nodes, all coupled in `pattern`
/// and ascending.
void add_rank_one(const SparsePattern& pattern, const std::vector<int>& equation,
                  std::span<const std::int32_t> nodes, double scale, const double* g,
                  std::vector<double>& values);

/// y = A x for a symmetric matrix stored by its lower triangle.
void symmetric_multiply(const SparsePattern& pattern, const std::vector<double>& values,
                        const double* x, double* y);

}  // namespace palpate::fem
