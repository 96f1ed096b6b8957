// SPDX-License-Identifier: AGPL-3.0-or-later
// The stiffness of a small block at rest, sparse and dense.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "fem/solid/solid_model.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {

struct Assembled {
  Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, 0.02, 2));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")}};
  std::vector<double> K;
  Eigen::MatrixXd dense;
  Eigen::VectorXd b;

  Assembled() {
    const auto& pattern = model.pattern();
    model.stiffness(Displacement::Zero(3, model.mesh().nodes()), K);
    dense = Eigen::MatrixXd::Zero(pattern.n, pattern.n);
    for (int c = 0; c < pattern.n; ++c)
      for (std::size_t k = to_index(pattern.start[to_index(c)]);
           k < to_index(pattern.start[to_index(c) + 1]); ++k)
        dense(pattern.row[k], c) = dense(c, pattern.row[k]) = K[k];
    b = Eigen::VectorXd::Random(pattern.n);
  }
};

}  // namespace palpate::fem
