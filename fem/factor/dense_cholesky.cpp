// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/dense_cholesky.hpp"

#include <f77blas.h>

#include <cblas.h>

#include <algorithm>

namespace palpate::fem {

namespace {

/// Columns of a panel: wide enough for BLAS to reach its full speed.
constexpr int kPanel = 64;

int size_of(const Eigen::MatrixXd& A) {
  return static_cast<int>(A.rows());
}

}  // namespace

bool factorize_in_place(Eigen::MatrixXd& A) {
  return factorize_in_place(A.data(), size_of(A), size_of(A));
}

bool factorize_in_place(double* A, int n, int stride) {
  char lower = 'L';
  blasint info = 0;
  BLASFUNC(dpotrf)(&lower, &n, A, &stride, &info);
  return info == 0;
}

Eigen::VectorXd solve_factorized(const Eigen::MatrixXd& L, Eigen::VectorXd b) {
  const int n = size_of(L);
  cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, n, L.data(), n, b.data(), 1);
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, n, L.data(), n, b.data(), 1);
  return b;
}

Eigen::MatrixXd product_with_transpose(const Eigen::MatrixXd& L) {
  const int n = size_of(L);
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(n, n), panel;
  for (int first = 0; first < n; first += kPanel) {
    const int columns = std::min(kPanel, n - first), rows = n - first;
    panel = L.block(first, first, rows, columns);
    panel.topRows(columns).triangularView<Eigen::StrictlyUpper>().setZero();
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, rows, columns, 1, panel.data(), rows, 1,
                product.data() + std::ptrdiff_t{first} * (n + 1), n);
  }
  return product;
}

}  // namespace palpate::fem
