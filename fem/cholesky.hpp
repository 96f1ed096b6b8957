// SPDX-License-Identifier: AGPL-3.0-or-later
// Sparse Cholesky factorization by CHOLMOD, supernodal, with METIS ordering.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/sparse_pattern.hpp"

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

/// One symbolic analysis, any number of numerical factorizations of the same pattern. A factor is
/// read-only in solve(): threads may share it, each with its own workspace.
class Cholesky {
 public:
  explicit Cholesky(const SparsePattern& pattern);
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  /// False when the matrix is not positive definite. @throws Error(Internal) when memory runs out.
  bool factorize(const std::vector<double>& values);

  /// x = A^-1 b; b and x hold n values and may be the same array.
  void solve(const double* b, double* x, SolveWorkspace& workspace) const;

  double factor_bytes() const;  ///< memory of the numerical factor

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Kernel set that OpenBLAS chose for this processor, e.g. "SkylakeX"; and one line of versions.
std::string blas_kernel();
std::string solver_versions();

/// Keep BLAS and CHOLMOD to one thread: sites, not matrices, are what runs in parallel. To be
/// called on every thread that solves.
void use_one_thread_per_site();

}  // namespace palpate::fem
