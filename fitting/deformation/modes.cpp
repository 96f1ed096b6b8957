// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/deformation/modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace palpate::fitting {
namespace {

constexpr Eigen::Index kOversampling = 16;
constexpr int kPowerIterations = 2;

Eigen::MatrixXf orthonormal(const Eigen::MatrixXf& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXf> qr(a);
  return qr.householderQ() * Eigen::MatrixXf::Identity(a.rows(), a.cols());
}

/// Numbers of mean 0: the same on every machine, unlike those of the distributions of the library.
Eigen::MatrixXf random_matrix(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 engine(1);
  Eigen::MatrixXf a(rows, columns);
  for (float& x : a.reshaped()) x = static_cast<float>(engine()) / 2147483648.0F - 1;
  return a;
}

}  // namespace

Modes leading_modes(const Eigen::MatrixXf& fields, Eigen::Index most, double least) {
  const Eigen::Index rank = std::min({most + kOversampling, fields.rows(), fields.cols()});
  Eigen::MatrixXf q = orthonormal(fields * random_matrix(fields.cols(), rank));
  for (int i = 0; i < kPowerIterations; ++i)
    q = orthonormal(fields * orthonormal(fields.transpose() * q));
  const Eigen::MatrixXf b = q.transpose() * fields;
  const Eigen::MatrixXd gram = (b * b.transpose()).cast<double>();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);  // ascending
  const Eigen::VectorXd squares = eigen.eigenvalues().reverse();
  Eigen::Index count = 0;
  while (count < std::min(most, rank) && squares[count] > 0 &&
         std::sqrt(squares[count]) > least * std::sqrt(squares[0]))
    ++count;
  const Eigen::MatrixXf leading =
      eigen.eigenvectors().rowwise().reverse().leftCols(count).cast<float>();
  return {q * leading, leading.transpose() * b};
}

}  // namespace palpate::fitting
