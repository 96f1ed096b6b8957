// SPDX-License-Identifier: AGPL-3.0-or-later
// Who eliminates what, when several threads factorize one matrix.
#pragma once

#include <vector>

#include "fem/factor/cholesky.hpp"

namespace palpate::fem {

/// The supernodes as a forest. The rows of a supernode below its own columns are among the rows of
/// its parent, which is the supernode of the first of them (Liu, SIAM Review 34, 1992).
struct EliminationTree {
  explicit EliminationTree(const SupernodalView& view);

  int supernodes() const { return static_cast<int>(parent.size()); }
  int below(int supernode) const;    ///< rows below its own columns
  double work(int supernode) const;  ///< multiplications of its elimination

  std::vector<int> parent;                 ///< -1: none; children come before their parent
  std::vector<std::vector<int>> children;  ///< ascending
  std::vector<int> columns, rows;          ///< of each supernode, its own columns counted in rows
};

/// Subtrees that one thread each eliminates, and what remains above them. The results of an
/// elimination do not depend on it.
struct EliminationPlan {
  /// Some parts a thread, so that they come out even; one part with all in it for one thread.
  EliminationPlan(const EliminationTree& tree, int threads);

  std::vector<std::vector<int>> parts;  ///< supernodes, ascending; the part with most work first
  std::vector<int> top;                 ///< ascending
  double update_bytes = 0;              ///< of what fronts leave to their parents, at most
  double column_bytes = 0;              ///< of the columns that each thread works on, at most
};

}  // namespace palpate::fem
