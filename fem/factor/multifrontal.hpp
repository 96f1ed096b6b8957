// SPDX-License-Identifier: AGPL-3.0-or-later
// Sparse Cholesky factorization on several threads, without a place for the factor.
#pragma once

#include <functional>
#include <vector>

#include "fem/factor/cholesky.hpp"
#include "fem/factor/elimination_plan.hpp"

namespace palpate::fem {

/// L L^T = P A P^T by the multifrontal method (Duff & Reid, ACM Trans. Math. Softw. 9, 1983): each
/// supernode is eliminated in a dense matrix of its own rows, its front, to which its children have
/// added what their elimination leaves of the rest. The columns of L are handed out as they come
/// and not kept. The bits do not depend on the number of threads: a front is the same work in the
/// same order whoever does it.
class Multifrontal {
 public:
  /// `view`: of an analysis of `pattern`; both are to outlive this.
  Multifrontal(const SparsePattern& pattern, const SupernodalView& view);

  /// Of the fronts, at most; the columns that are handed out are not counted.
  double working_bytes(int threads) const {
    const EliminationPlan plan(tree_, threads);
    return plan.update_bytes + plan.column_bytes;
  }

  /// Takes the columns of L of a supernode, rows by columns, what is above the diagonal undefined.
  /// Called on any thread of the factorization, for several supernodes at once.
  using Finished = std::function<void(int supernode, const double* columns)>;

  /// False when A, `values` on the pattern, is not positive definite. @throws std::bad_alloc
  bool factorize(const std::vector<double>& values, int threads, const Finished& finished) const;

 private:
  friend class Elimination;
  struct Entry {
    int row;    ///< of P A P^T
    int value;  ///< index
  };

  SupernodalView view_;
  EliminationTree tree_;
  std::vector<std::size_t> entry_start_;  ///< by columns of P A P^T
  std::vector<Entry> entries_;
};

}  // namespace palpate::fem
