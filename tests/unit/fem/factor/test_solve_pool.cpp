// SPDX-License-Identifier: AGPL-3.0-or-later
// Fast enough for the thread sanitizer.
#include "fem/factor/solve_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <latch>
#include <thread>
#include <vector>

#include "tests/unit/fem/factor/assembled_block.hpp"

namespace palpate::fem {
namespace {

class SolvePools : public testing::Test {
 protected:
  Assembled block;
  RestFactor factor{block.model.pattern(), nested_dissection(block.model.pattern()), block.K,
                    "block"};
  Eigen::VectorXd expected = block.dense.ldlt().solve(block.b);
};

/// Runs `work(member, i)` on `count` threads.
void run(SolvePool& pool, int count, const std::function<void(SolvePool::Member&, int)>& work) {
  std::vector<std::thread> threads;
  for (int i = 0; i < count; ++i)
    threads.emplace_back([&, i] {
      SolvePool::Member member(pool);
      work(member, i);
    });
  for (std::thread& thread : threads) thread.join();
}

/// More than fill a block, and each leaves after another number of solves.
TEST_F(SolvePools, ServesAllMembersAndLetsThemLeave) {
  for (const int cores : {1, 2, 5}) {
    SolvePool pool(factor, cores);
    constexpr int kMembers = 2 * kBatch + 3;
    std::vector<double> error(kMembers, 1.0);
    run(pool, kMembers, [&](SolvePool::Member& member, int i) {
      Eigen::VectorXd x;
      for (int turn = 0; turn <= i % 7; ++turn) member.solve((i + 1.0) * block.b, x);
      error[to_index(i)] = (x - (i + 1.0) * expected).norm() / ((i + 1.0) * expected.norm());
    });
    EXPECT_LT(*std::max_element(error.begin(), error.end()), 1e-3) << cores << " cores";
  }
}

TEST_F(SolvePools, GivesTheSameBitsInAnyCompany) {
  Eigen::VectorXd alone;
  {
    SolvePool pool(factor, 1);
    SolvePool::Member(pool).solve(block.b, alone);
  }
  SolvePool pool(factor, 3);
  std::atomic<int> wrong{0};
  run(pool, 20, [&](SolvePool::Member& member, int i) {
    Eigen::VectorXd x;
    for (int turn = 0; turn < 20; ++turn) {
      const double scale = (i + turn) % 3 == 0 ? 1 : 1 + i;
      member.solve(scale * block.b, x);
      if (scale == 1 && x != alone) ++wrong;
    }
  });
  EXPECT_EQ(wrong, 0);
}

/// No more run at a time than there are cores, and with enough of them as many.
TEST_F(SolvePools, RunsAsManyAtATimeAsThereAreCores) {
  for (const int cores : {1, 2, 4}) {
    SolvePool pool(factor, cores);
    std::atomic<int> running{0}, most{0}, started{0};
    std::latch all(cores);
    run(pool, 3 * cores, [&](SolvePool::Member& member, int) {
      Eigen::VectorXd x;
      for (int turn = 0; turn < 10; ++turn) {
        const int now = ++running;
        for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) continue;
        // The first ones on the cores go on together only.
        if (turn == 0 && started++ < cores) all.arrive_and_wait();
        --running;
        member.solve(block.b, x);
      }
    });
    EXPECT_EQ(most, cores);
  }
}

/// One member computes until all others have done a hundred solves: they need its core for none.
TEST_F(SolvePools, AMemberThatDoesNotSolveDelaysNoOther) {
  SolvePool pool(factor, 2);
  constexpr int kMembers = 8;
  std::latch done(kMembers - 1);
  run(pool, kMembers, [&](SolvePool::Member& member, int i) {
    if (i == 0) return done.wait();
    Eigen::VectorXd x;
    for (int turn = 0; turn < 100; ++turn) member.solve(block.b, x);
    done.count_down();
  });
}

/// On one core: a member that waits for another lets it run.
TEST_F(SolvePools, AMemberThatWaitsLeavesItsCoreToOthers) {
  SolvePool pool(factor, 1);
  std::latch done(3);
  run(pool, 4, [&](SolvePool::Member& member, int i) {
    Eigen::VectorXd x;
    if (i == 0) {
      member.without_core([&] { done.wait(); });
    } else {
      member.solve(block.b, x);
      done.count_down();
    }
    member.solve(block.b, x);
    EXPECT_LT((x - expected).norm(), 1e-3 * expected.norm());
  });
}

}  // namespace
}  // namespace palpate::fem
