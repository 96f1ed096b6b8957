// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/deformation/modes.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>

namespace palpate::fitting {
namespace {

/// 60 x 40, with singular values that fall by a fifth from one to the next.
Eigen::MatrixXf falling() {
  Eigen::MatrixXf a = Eigen::MatrixXf::Zero(60, 40);
  for (int k = 0; k < 40; ++k) {
    Eigen::VectorXf u(60), v(40);
    for (int i = 0; i < 60; ++i) u[i] = static_cast<float>(std::cos(0.05 * k * (2 * i + 1)));
    for (int i = 0; i < 40; ++i) v[i] = static_cast<float>(std::sin(0.07 * (k + 1) * (i + 1)));
    a += std::pow(0.8F, static_cast<float>(k)) * u * v.transpose();
  }
  return a;
}

TEST(LeadingModes, LeaveOutAsLittleAsAnyShapesCan) {
  const Eigen::MatrixXf fields = falling();
  const Eigen::JacobiSVD<Eigen::MatrixXf> svd(fields);
  for (const Eigen::Index count : {1, 4, 10}) {
    const Modes modes = leading_modes(fields, count, 0);
    ASSERT_EQ(modes.shapes.cols(), count);
    const Eigen::MatrixXf gram = modes.shapes.transpose() * modes.shapes;
    EXPECT_TRUE(gram.isIdentity(1e-4F));
    // [Eckart & Young 1936]: the best that `count` shapes can do.
    const float best = svd.singularValues().tail(40 - count).norm();
    EXPECT_LE((fields - modes.shapes * modes.coefficients).norm(), 1.001F * best);
  }
}

TEST(LeadingModes, LeaveOutWhatIsNegligible) {
  const Eigen::VectorXf u = Eigen::VectorXf::LinSpaced(50, 0, 1), v = u.array().sin();
  const Eigen::MatrixXf fields =
      u * Eigen::RowVectorXf::LinSpaced(30, -1, 2) +
      v * Eigen::RowVectorXf::LinSpaced(30, 1, 0).array().square().matrix();
  EXPECT_EQ(leading_modes(fields, 20, 1e-4).shapes.cols(), 2);
  EXPECT_EQ(leading_modes(Eigen::MatrixXf::Zero(9, 5), 20, 1e-4).shapes.cols(), 0);
}

}  // namespace
}  // namespace palpate::fitting
