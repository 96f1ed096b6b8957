// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/autoregressive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace palpate::fitting {
namespace {

TEST(AutoregressiveProduct, IsThatOfTheMatrixWrittenOut) {
  const std::vector<int> stretches{4, 1, 0, 3};
  const Eigen::MatrixXd X = Eigen::MatrixXd::Random(8, 3);
  for (const double r : {-0.4, 0.0, 0.7, 0.98}) {
    Eigen::MatrixXd V = Eigen::MatrixXd::Zero(8, 8);
    int first = 0;
    for (const int m : stretches) {
      for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j) V(first + i, first + j) = std::pow(r, std::abs(i - j));
      first += m;
    }
    EXPECT_LT((autoregressive_product(X, r, stretches) - V * X).norm(), 1e-13) << r;
  }
}

}  // namespace
}  // namespace palpate::fitting
