// SPDX-License-Identifier: AGPL-3.0-or-later
// The factor of the rest stiffness, shared by all sites, and solves with many right-hand sides.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "fem/factor/cholesky.hpp"
#include "fem/factor/large_pages.hpp"
#include "fem/factor/memory.hpp"

namespace palpate::fem {

class Multifrontal;

/// Right-hand sides solved at once. Sixteen floats fill one AVX-512 register.
inline constexpr int kBatch = 16;

/// A supernodal Cholesky factor in single precision, laid out for solves with kBatch right-hand
/// sides. The solve is a preconditioner: single precision costs no accuracy and halves the traffic,
/// which dominates its time. The factorization is in single precision as well, unless its solutions
/// of test loads are off by more than a few percent. Each right-hand side is one SIMD lane of every
/// operation: its solution has the same bits whatever the other right-hand sides are.
class RestFactor {
 public:
  /// @throws Error(Geometry) when the matrix is not positive definite; `owner` names the body.
  /// @throws Error(Configuration) when the factorization needs more than the memory it may use.
  /// @throws Error(Internal) when memory runs out.
  RestFactor(const SparsePattern& pattern, const std::vector<int>& permutation,
             const std::vector<double>& values, const std::string& owner,
             const FactorResources& resources = {});

  /// Makes this the factor of `ratio` times the matrix, as when all laws become stiffer by that
  /// ratio. Not while solves run.
  void scale(double ratio) { inverse_scale_ /= ratio; }
  /// K0^-1 b is this times the solution of solve().
  double inverse_scale() const { return inverse_scale_; }

  int size() const { return n_; }
  /// Whether the factorization was in double precision.
  bool in_double_precision() const { return in_double_precision_; }
  double bytes() const { return static_cast<double>(values_.size()) * sizeof(float); }

  /// In place: block[unknown * kBatch + right-hand side]. `scratch` is resized as needed.
  void solve(std::vector<float>& block, std::vector<float>& scratch) const;

 private:
  struct Supernode {
    int first_column, columns, rows_below;
    std::size_t row_list;  ///< into rows_
    std::size_t values;    ///< into values_, where its panels start
  };

  /// Stores the columns of L of a supernode.
  template <class Number>
  void store(int supernode, const Number* columns);
  /// False when the matrix is not positive definite in this precision.
  template <class Number>
  bool factorize(const Multifrontal& fronts, const std::vector<double>& values,
                 const FactorResources& resources);
  /// The largest error of the solution of a test load, over the solution.
  double error_of_solutions(const SparsePattern& pattern, const std::vector<double>& values) const;
  void forward(float* y) const;
  void backward(float* y) const;

  int n_ = 0;
  double inverse_scale_ = 1;
  bool in_double_precision_ = false;
  std::vector<Supernode> supernodes_;
  std::vector<int> rows_, permutation_;
  LargeVector<float> values_;
};

/// Reuses a factor in successive campaigns on one body that differ only in the constants of their
/// laws, as in a calibration. A factor is a preconditioner and accuracy does not depend on it: it
/// serves while the stiffness at rest is nearly a multiple of the one that was factorized, exactly
/// so when all laws scale together. The elimination order is computed once. Not thread-safe.
class FactorCache {
 public:
  /// A factor of `values`, approximately. `pattern` must be that of every call before.
  /// @throws Error as RestFactor.
  std::shared_ptr<const RestFactor> factor_of(const SparsePattern& pattern,
                                              const std::vector<double>& values,
                                              const std::string& owner,
                                              const FactorResources& resources);
  /// Computed by the first call.
  const std::vector<int>& permutation(const SparsePattern& pattern);

  int factorizations() const { return factorizations_; }

 private:
  std::vector<int> permutation_;
  std::vector<double> diagonal_;  ///< of the matrix that was factorized
  double scale_ = 1;  ///< of the matrix that the factor approximates, over the one factorized
  std::shared_ptr<RestFactor> factor_;
  int factorizations_ = 0;
};

}  // namespace palpate::fem
