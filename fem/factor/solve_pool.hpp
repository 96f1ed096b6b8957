// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "fem/factor/rest_factor.hpp"

namespace palpate::fem {

/// Sites, each on its own thread, that take turns on the cores and share block solves.
///
/// A thread runs while it has a core, until it asks for a solve. Its core then goes to the thread
/// that has been ready for longest. Where none is ready, the core serves the thread together with
/// those that have waited for longest, up to kBatch in one block: a block is nearly full as long as
/// that many sites run beside those on other cores. A site that computes for long on its own thus
/// keeps its core and nothing else, and no core is idle while a site is ready.
class SolvePool {
 public:
  SolvePool(const RestFactor& factor, int cores) : factor_(factor), idle_(cores) {}
  SolvePool(const SolvePool&) = delete;
  SolvePool& operator=(const SolvePool&) = delete;

  /// The membership of a site thread while it runs.
  class Member {
   public:
    explicit Member(SolvePool& pool);  ///< Blocks until a core is free.
    ~Member();
    Member(const Member&) = delete;
    Member& operator=(const Member&) = delete;

    /// x = K0^-1 b. Other sites may run in the meantime.
    void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

    /// Calls `wait`, which may block, without a core.
    template <class Wait>
    void without_core(Wait&& wait) {
      give_core();
      wait();
      take_core();
    }

   private:
    friend class SolvePool;
    void give_core();
    void take_core();

    SolvePool& pool_;
    bool has_core_ = false;
    std::condition_variable given_;
    std::vector<float> column_;  ///< a right-hand side, and then its solution
  };

 private:
  using Lock = std::unique_lock<std::mutex>;
  /// Memory of a block solve.
  struct Block {
    std::vector<float> values, scratch;
  };

  void wait_for_core(Member& member, Lock& lock);
  void give_idle_cores();
  /// Solves for `served`, by the core of the calling thread, in one block.
  void solve(const std::vector<Member*>& served, Lock& lock);
  void solve(const std::vector<Member*>& served, Block& block) const;
  /// Adds those that have waited for longest to a block.
  void fill(std::vector<Member*>& served);

  const RestFactor& factor_;
  std::mutex mutex_;             ///< held for short: neither in a solve nor while a site runs
  int idle_;                     ///< cores
  std::deque<Member*> ready_;    ///< for a core
  std::deque<Member*> waiting_;  ///< for a solve
  std::vector<std::unique_ptr<Block>> blocks_;  ///< that are not in use
};

}  // namespace palpate::fem
