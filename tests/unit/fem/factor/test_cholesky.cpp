// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/cholesky.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <thread>

#include "tests/unit/fem/factor/assembled_block.hpp"

namespace palpate::fem {
namespace {

TEST(Cholesky, SolvesAsADenseFactorizationDoes) {
  const Assembled a;
  Cholesky factor(a.model.pattern());
  ASSERT_TRUE(factor.factorize(a.K));
  SolveWorkspace workspace;
  Eigen::VectorXd x(a.b.size());
  factor.solve(a.b.data(), x.data(), workspace);
  const Eigen::VectorXd expected = a.dense.ldlt().solve(a.b);
  EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm());
}

TEST(Cholesky, RefusesAnIndefiniteMatrix) {
  Assembled a;
  a.K[to_index(a.model.pattern().start[5])] = -1;
  Cholesky factor(a.model.pattern());
  EXPECT_FALSE(factor.factorize(a.K));
}

TEST(Cholesky, EliminatesTheLastUnknownsLast) {
  const Assembled a;
  const std::vector<int> last{3, 4, 5, 60, 61, 62, 90, 91, 92};
  const std::vector<int> order = nested_dissection(a.model.pattern());
  for (const auto* permutation : {static_cast<const std::vector<int>*>(nullptr), &order}) {
    const Cholesky factor(a.model.pattern(), permutation, last);
    const std::vector<int> found = factor.last_unknowns();
    EXPECT_TRUE(std::is_permutation(found.begin(), found.end(), last.begin(), last.end()));
  }
}

/// Lower triangle of the seven-point stencil on a grid of n^3 points.
SparsePattern stencil(int n) {
  SparsePattern pattern;
  pattern.n = n * n * n;
  pattern.start = {0};
  for (int i = 0; i < pattern.n; ++i) {
    pattern.row.push_back(i);
    if ((i + 1) % n != 0) pattern.row.push_back(i + 1);
    if ((i / n + 1) % n != 0) pattern.row.push_back(i + n);
    if (i + n * n < pattern.n) pattern.row.push_back(i + n * n);
    pattern.start.push_back(static_cast<int>(pattern.row.size()));
  }
  return pattern;
}

/// Ends the process by SIGTERM as soon as somebody else handles it.
void terminate_when_metis_is_at_work() {
  sigset_t sigterm;
  sigemptyset(&sigterm);
  sigaddset(&sigterm, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &sigterm, nullptr);
  struct sigaction now {};
  do sigaction(SIGTERM, nullptr, &now);
  while (now.sa_handler == SIG_DFL);
  kill(getpid(), SIGTERM);
}

TEST(NestedDissection, LeavesSigtermToTheProcess) {
  const SparsePattern pattern = stencil(40);
  const auto order_and_be_terminated = [&] {
    std::thread sender(terminate_when_metis_is_at_work);
    nested_dissection(pattern);
    sender.join();
  };
  EXPECT_EXIT(order_and_be_terminated(), ::testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace palpate::fem
