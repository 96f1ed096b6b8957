// SPDX-License-Identifier: AGPL-3.0-or-later
// Which thread eliminates which supernodes when several factorize one matrix.
#pragma once

#include <vector>

#include "fem/factor/cholesky.hpp"

namespace palpate::fem {

/// The supernodes as a forest. The rows of a supernode below its own columns are among the rows of
/// its parent, which is the supernode of the first of them (Liu, SIAM Review 34, 1992). A view may
/// end before the last columns: a supernode whose rows below are among those has no parent.
struct EliminationTree {
  explicit EliminationTree(const SupernodalView& view);

  int supernodes() const { return static_cast<int>(parent.size()); }
  int below(int supernode) const;    ///< rows below its own columns
  double work(int supernode) const;  ///< multiplications of its elimination

  std::vector<int> parent;                 ///< -1: none; children come before their parent
  std::vector<std::vector<int>> children;  ///< ascending
  std::vector<int> columns, rows;          ///< of each supernode, its own columns counted in rows
};

/// Subtrees, each eliminated by one thread, and the supernodes above them. The factor does not
/// depend on the plan.
struct EliminationPlan {
  /// Several parts for each thread, to balance the work; a single part for one thread.
  EliminationPlan(const EliminationTree& tree, int threads);

  std::vector<std::vector<int>> parts;  ///< supernodes, ascending; the part with most work first
  std::vector<int> top;                 ///< ascending
  double update_numbers = 0;  ///< upper bound, of the updates that fronts pass to their parents
  double column_numbers = 0;  ///< upper bound, of the columns that the threads work on
};

}  // namespace palpate::fem
