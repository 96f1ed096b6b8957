// SPDX-License-Identifier: AGPL-3.0-or-later
// Sparse Cholesky factorization on several threads that does not store the factor.
#pragma once

#include <functional>
#include <vector>

#include "fem/factor/cholesky.hpp"
#include "fem/factor/elimination_plan.hpp"
#include "fem/factor/front_memory.hpp"

namespace palpate::fem {

/// L L^T = P A P^T by the multifrontal method (Duff & Reid, ACM Trans. Math. Softw. 9, 1983): each
/// supernode is eliminated in a dense matrix of its rows, its front, to which its children have
/// added the Schur complements of their elimination. The columns of L are passed to a callback and
/// not stored. The bits do not depend on the number of threads: every front is computed in the same
/// order. In single precision (Number = float) it takes half the time and half the memory, and the
/// factor of a matrix of condition c is off by about 1e-7 c.
class Multifrontal {
 public:
  /// `view`: of an analysis of `pattern`, or of its first supernodes; what it points to must
  /// outlive this.
  Multifrontal(const SparsePattern& pattern, const SupernodalView& view);

  /// Upper bound of the memory of the fronts, without the columns that are passed to the callback.
  template <class Number>
  double working_bytes(int threads) const {
    const EliminationPlan plan(tree_, threads);
    return sizeof(Number) * (plan.update_numbers + plan.column_numbers);
  }

  /// Receives the columns of L of a supernode, column-major, undefined above the diagonal. Called
  /// from any thread of the factorization, concurrently for several supernodes.
  template <class Number>
  using Finished = std::function<void(int supernode, const Number* columns)>;

  /// Receives what the elimination of a supernode leaves to rows that no supernode of the view has:
  /// the lower triangle of -L21 L21^T, column-major. Called as above.
  template <class Number>
  using Left = std::function<void(int supernode, const Number* update)>;

  /// False when A, `values` on the pattern, is not positive definite. `memory`: of the fronts, kept
  /// for the next factorization; without it memory is requested and freed anew. @throws
  /// std::bad_alloc
  template <class Number>
  bool factorize(const std::vector<double>& values, int threads, const Finished<Number>& finished,
                 const Left<Number>& left = {}, FrontMemory<Number>* memory = nullptr) const;

 private:
  template <class Number>
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
