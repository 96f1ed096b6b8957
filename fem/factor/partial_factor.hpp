// SPDX-License-Identifier: AGPL-3.0-or-later
// The factor of some unknowns of a matrix, and the Schur complement of the others.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/factor/cholesky.hpp"
#include "fem/factor/large_pages.hpp"
#include "fem/factor/multifrontal.hpp"

namespace palpate::fem {

enum class Precision { Single, Double };

/// A symmetric matrix of the unknowns e, which are eliminated, and k, which are kept,
///   A = [A_ee A_ek; A_ke A_kk],   A_ee = L L^T (P A_ee P^T in full),   S = A_kk - A_ke A_ee^-1
///   A_ek.
/// A_ee must be positive definite; S may be indefinite. One symbolic analysis, any number of
/// numerical factorizations of the same pattern, by fronts (Multifrontal), whose bits do not depend
/// on the threads. Not thread-safe.
class PartialFactor {
 public:
  /// `permutation`: elimination order of all unknowns, minimum degree without one; `kept` leave it.
  /// `fronts`: for the factorizations, which may share it with others; it must outlive this.
  PartialFactor(const SparsePattern& pattern, const std::vector<int>* permutation,
                const std::vector<int>& kept, SharedFronts* fronts = nullptr)
      : PartialFactor(pattern, Cholesky(pattern, permutation, kept), fronts) {}
  PartialFactor(const PartialFactor&) = delete;
  PartialFactor& operator=(const PartialFactor&) = delete;

  /// In single precision it takes half the time and memory, and solutions are off by about 1e-7 of
  /// the condition of A_ee. False when A_ee is not positive definite in that precision. @throws
  /// Error(Internal) when memory runs out.
  bool factorize(const std::vector<double>& values, Precision precision, int threads = 1);

  /// Memory of the factor and, at most, of the fronts while it is computed.
  double bytes(Precision precision, int threads) const;

  /// The unknowns k, in the order of S.
  const std::vector<int>& kept() const { return kept_; }
  /// S of the last factorization, both triangles.
  const Eigen::MatrixXd& schur_complement() const { return S_; }

  /// The solution of A x = b in two halves. `load`: b_k - A_ke A_ee^-1 b_e, in the order of S.
  void solve_forward(const Eigen::VectorXd& b, Eigen::VectorXd& load);
  /// x with x_k given in the order of S, after solve_forward().
  void solve_backward(const Eigen::VectorXd& on_kept, Eigen::VectorXd& x);

 private:
  /// The columns of the kept unknowns cut off; owns what Multifrontal refers to.
  struct Cut {
    Cut(const SupernodalView& whole, int unknowns, int kept);
    SupernodalView view() const;

    std::vector<int> permutation, first_column, row_start, rows;
  };
  /// The values of L, supernode after supernode, by columns.
  template <class Number>
  struct Columns {
    LargeVector<Number> values;
    Eigen::Vector<Number, Eigen::Dynamic> ordered;  ///< of a solve, in the order of elimination
    Eigen::Vector<Number, Eigen::Dynamic> below;    ///< of a supernode, scratch memory
  };

  PartialFactor(const SparsePattern& pattern, const Cholesky& analysis, SharedFronts* fronts);

  int eliminated() const { return cut_.first_column.back(); }
  int columns(int supernode) const;
  int rows(int supernode) const;
  void take_kept_block(const std::vector<double>& values);
  template <class Number>
  bool factorize_columns(const std::vector<double>& values, int threads, Columns<Number>& columns);
  template <class Number>
  void add_update(int supernode, const Number* update);
  template <class Number>
  void forward(const Eigen::VectorXd& b, Columns<Number>& columns, Eigen::VectorXd& load) const;
  template <class Number>
  void backward(const Eigen::VectorXd& on_kept, Columns<Number>& columns, Eigen::VectorXd& x) const;

  /// An entry of A_kk: its value, and where it is in S.
  struct KeptEntry {
    int value, row, column;
  };

  std::vector<int> kept_;
  Cut cut_;
  Multifrontal fronts_;
  SharedFronts* shared_;
  SharedFronts own_;                ///< where none is shared
  std::vector<std::size_t> start_;  ///< of each supernode in the values of L
  std::vector<KeptEntry> kept_entries_;
  Eigen::MatrixXd S_;
  Precision precision_ = Precision::Double;
  Columns<float> single_;
  Columns<double> double_;
};

}  // namespace palpate::fem
