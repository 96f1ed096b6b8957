// SPDX-License-Identifier: AGPL-3.0-or-later
// Sparse Cholesky factorization by CHOLMOD, supernodal.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "fem/factor/sparse_pattern.hpp"

namespace palpate::fem {

/// Scratch memory of one thread for solves with a shared factor.
class SolveWorkspace {
 public:
  SolveWorkspace();
  ~SolveWorkspace();
  SolveWorkspace(const SolveWorkspace&) = delete;
  SolveWorkspace& operator=(const SolveWorkspace&) = delete;

 private:
  friend class Cholesky;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The values of a factor L of P A P^T: supernode k spans the columns first_column[k] .. [k+1],
/// has the rows `rows[row_start[k] .. row_start[k+1]]` (its own columns first), stored by columns.
struct SupernodalView {
  int supernodes = 0;
  const int* permutation = nullptr;
  const int* first_column = nullptr;
  const int* row_start = nullptr;
  const int* value_start = nullptr;
  const int* rows = nullptr;
  const double* values = nullptr;
};

/// One symbolic analysis, any number of numerical factorizations of the same pattern. A factor is
/// read-only in solve(): threads may share it, each with its own workspace.
class Cholesky {
 public:
  /// Ordered by minimum degree, or by a permutation made for the same pattern. METIS is not called
  /// here: it draws from the random numbers of the process, which threads would share.
  /// The unknowns `last` are eliminated after all others, whatever fill that costs.
  explicit Cholesky(const SparsePattern& pattern, const std::vector<int>* permutation = nullptr,
                    const std::vector<int>& last = {});
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  /// False when the matrix is not positive definite. @throws Error(Internal) when memory runs out.
  bool factorize(const std::vector<double>& values);

  /// x = A^-1 b; b and x hold n values and may be the same array.
  void solve(const double* b, double* x, SolveWorkspace& workspace) const;

  /// The unknowns `last` in their order of elimination.
  std::vector<int> last_unknowns() const;

  double bytes() const;  ///< of the values of the factor, known before factorize()

  SupernodalView view() const;  ///< valid until the next factorization

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Fill-reducing order of a large pattern by METIS nested dissection. Not thread-safe.
std::vector<int> nested_dissection(const SparsePattern& pattern);

/// Kernel set that OpenBLAS chose for this processor, e.g. "SkylakeX".
std::string blas_kernel();
/// Versions of CHOLMOD and OpenBLAS, one line.
std::string solver_versions();

/// Limits BLAS and CHOLMOD to one thread: sites run in parallel, matrices do not. To be called on
/// every thread that solves.
void use_one_thread_per_site();

}  // namespace palpate::fem
