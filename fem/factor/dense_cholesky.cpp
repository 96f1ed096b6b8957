// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/dense_cholesky.hpp"

#include <cblas.h>
#include <f77blas.h>

namespace palpate::fem {

namespace {

int size_of(const Eigen::MatrixXf& A) {
  return static_cast<int>(A.rows());
}

/// The first `count` of x by L^-1, or L^-T where `transposed`.
void solve_with(const Eigen::MatrixXf& L, CBLAS_TRANSPOSE transposed, Eigen::Index count,
                Eigen::VectorXf& x) {
  cblas_strsv(CblasColMajor, CblasLower, transposed, CblasNonUnit, static_cast<int>(count),
              L.data(), size_of(L), x.data(), 1);
}

}  // namespace

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

bool factorize_in_place(Eigen::MatrixXf& A) {
  return factorize_in_place(A.data(), size_of(A), size_of(A));
}

Eigen::VectorXf solve_factorized(const Eigen::MatrixXf& L, Eigen::VectorXf b) {
  solve_with(L, CblasNoTrans, b.size(), b);
  solve_with(L, CblasTrans, b.size(), b);
  return b;
}

bool eliminate_first(Eigen::Index count, Eigen::MatrixXf& A) {
  const int n = size_of(A), first = static_cast<int>(count), others = n - first;
  if (first == 0) return true;
  if (!factorize_in_place(A.data(), first, n)) return false;
  if (others == 0) return true;
  float* below = A.data() + count;
  cblas_strsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, others, first, 1,
              A.data(), n, below, n);
  cblas_ssyrk(CblasColMajor, CblasLower, CblasNoTrans, others, first, -1, below, n, 1,
              A.data() + count * (n + 1), n);
  return true;
}

void solve_first_forward(const Eigen::MatrixXf& A, Eigen::Index count, Eigen::VectorXf& x) {
  solve_with(A, CblasNoTrans, count, x);
}

void solve_first_backward(const Eigen::MatrixXf& A, Eigen::Index count, Eigen::VectorXf& x) {
  solve_with(A, CblasTrans, count, x);
}

}  // namespace palpate::fem
