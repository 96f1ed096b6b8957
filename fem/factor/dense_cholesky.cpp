// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/dense_cholesky.hpp"

#include <f77blas.h>

#include <utility>

#include "fem/factor/blas.hpp"

namespace palpate::fem {

namespace {

template <class Matrix>
int size_of(const Matrix& A) {
  return static_cast<int>(A.rows());
}

template <class Matrix, class Vector>
Vector solve_with(const Matrix& L, Vector b) {
  using Number = typename Matrix::Scalar;
  const int n = size_of(L);
  for (const auto transposed : {CblasNoTrans, CblasTrans})
    Blas<Number>::trsv(CblasColMajor, CblasLower, transposed, CblasNonUnit, n, L.data(), n,
                       b.data(), 1);
  return b;
}

}  // namespace

bool factorize_in_place(Eigen::MatrixXd& A) {
  return factorize_in_place(A.data(), size_of(A), size_of(A));
}

bool factorize_in_place(Eigen::MatrixXf& A) {
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
  return solve_with(L, std::move(b));
}

Eigen::VectorXf solve_factorized(const Eigen::MatrixXf& L, Eigen::VectorXf b) {
  return solve_with(L, std::move(b));
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

}  // namespace palpate::fem
