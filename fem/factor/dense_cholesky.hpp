// SPDX-License-Identifier: AGPL-3.0-or-later
// Dense Cholesky factors of some hundred unknowns, by BLAS.
#pragma once

#include <Eigen/Core>

namespace palpate::fem {

/// A = L L^T in place, for `n` rows and columns, each of which starts `stride` numbers after the
/// last: reads and writes the lower triangle of A, the upper one is not touched. False when A is
/// not positive definite: the contents of A are then undefined.
bool factorize_in_place(double* A, int n, int stride);
bool factorize_in_place(float* A, int n, int stride);
/// The same for a whole matrix.
bool factorize_in_place(Eigen::MatrixXf& A);

/// x = (L L^T)^-1 b with the lower triangle from factorize_in_place().
Eigen::VectorXf solve_factorized(const Eigen::MatrixXf& L, Eigen::VectorXf b);

/// Eliminates the first `count` unknowns of A, of which it reads and writes the lower triangle: the
/// first columns become those of the factor, and the block of the other unknowns their Schur
/// complement. False when the first block is not positive definite.
bool eliminate_first(Eigen::Index count, Eigen::MatrixXf& A);
/// The first `count` of x by L^-1 and by L^-T, L the factor of the first block of such an A.
void solve_first_forward(const Eigen::MatrixXf& A, Eigen::Index count, Eigen::VectorXf& x);
void solve_first_backward(const Eigen::MatrixXf& A, Eigen::Index count, Eigen::VectorXf& x);

}  // namespace palpate::fem
