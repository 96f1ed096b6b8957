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

bool factorize_in_place(float* A, int n, int stride) {
  char lower = 'L';
  blasint info = 0;
  BLASFUNC(spotrf)(&lower, &n, A, &stride, &info);
  return info == 0;
}

Eigen::VectorXd solve_factorized(const Eigen::MatrixXd& L, Eigen::VectorXd b) {
  const int n = size_of(L);
  cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, n, L.data(), n, b.data(), 1);
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, n, L.data(), n, b.data(), 1);
  return b;
}

bool eliminate_first(Eigen::Index count, Eigen::MatrixXd& A) {
  const int n = size_of(A), first = static_cast<int>(count), others = n - first;
  if (first == 0) return true;
  if (!factorize_in_place(A.data(), first, n)) return false;
  if (others == 0) return true;
  double* below = A.data() + count;
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, others, first, 1,
              A.data(), n, below, n);
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, others, first, -1, below, n, 1,
              A.data() + count * (n + 1), n);
  return true;
}

void solve_first_forward(const Eigen::MatrixXd& A, Eigen::Index count, Eigen::VectorXd& x) {
  cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, static_cast<int>(count),
              A.data(), size_of(A), x.data(), 1);
}

void solve_first_backward(const Eigen::MatrixXd& A, Eigen::Index count, Eigen::VectorXd& x) {
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, static_cast<int>(count),
              A.data(), size_of(A), x.data(), 1);
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
