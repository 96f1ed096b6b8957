// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/solve_pool.hpp"

#include <algorithm>
#include <utility>

#include "format/to_index.hpp"

namespace palpate::fem {

void SolvePool::wait_for_core(Member& member, Lock& lock) {
  member.given_.wait(lock, [&] { return member.has_core_; });
}

void SolvePool::give_idle_cores() {
  for (; idle_ > 0 && !ready_.empty(); --idle_) {
    ready_.front()->has_core_ = true;
    ready_.front()->given_.notify_one();
    ready_.pop_front();
  }
}

void SolvePool::fill(std::vector<Member*>& served) {
  while (served.size() < to_index(kBatch) && !waiting_.empty()) {
    served.push_back(waiting_.front());
    waiting_.pop_front();
  }
}

void SolvePool::solve(const std::vector<Member*>& served, Block& block) const {
  const auto n = to_index(factor_.size());
  block.values.resize(n * to_index(kBatch));
  for (std::size_t i = 0; i < n; ++i) {
    float* row = &block.values[i * to_index(kBatch)];
    for (std::size_t k = 0; k < served.size(); ++k) row[k] = served[k]->column_[i];
    std::fill(row + served.size(), row + kBatch, 0.0F);
  }
  factor_.solve(block.values, block.scratch);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < served.size(); ++k)
      served[k]->column_[i] = block.values[i * to_index(kBatch) + k];
}

void SolvePool::solve(const std::vector<Member*>& served, Lock& lock) {
  std::unique_ptr<Block> block;
  if (blocks_.empty()) {
    block = std::make_unique<Block>();
  } else {
    block = std::move(blocks_.back());
    blocks_.pop_back();
  }
  lock.unlock();
  solve(served, *block);
  lock.lock();
  blocks_.push_back(std::move(block));
}

SolvePool::Member::Member(SolvePool& pool) : pool_(pool), column_(to_index(pool.factor_.size())) {
  take_core();
}

SolvePool::Member::~Member() {
  give_core();
}

void SolvePool::Member::take_core() {
  Lock lock(pool_.mutex_);
  pool_.ready_.push_back(this);
  pool_.give_idle_cores();
  pool_.wait_for_core(*this, lock);
}

/// The last thread that runs must serve those that wait: nobody else would.
void SolvePool::Member::give_core() {
  Lock lock(pool_.mutex_);
  if (pool_.ready_.empty() && !pool_.waiting_.empty()) {
    std::vector<Member*> served;
    pool_.fill(served);
    pool_.solve(served, lock);
    pool_.ready_.insert(pool_.ready_.end(), served.begin(), served.end());
  }
  has_core_ = false;
  ++pool_.idle_;
  pool_.give_idle_cores();
}

void SolvePool::Member::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  // Scaled to unit length: small residuals would lose bits in the range of a float.
  const double length = b.norm();
  if (length == 0) {
    x.setZero(b.size());
    return;
  }
  Eigen::Map<Eigen::VectorXf> column(column_.data(), b.size());
  column = (b / length).cast<float>();
  Lock lock(pool_.mutex_);
  if (pool_.ready_.empty()) {
    std::vector<Member*> served{this};
    pool_.fill(served);
    pool_.solve(served, lock);
    pool_.ready_.insert(pool_.ready_.end(), served.begin() + 1, served.end());
    pool_.give_idle_cores();
  } else {
    pool_.waiting_.push_back(this);
    has_core_ = false;
    ++pool_.idle_;
    pool_.give_idle_cores();
    pool_.wait_for_core(*this, lock);
  }
  lock.unlock();
  const double scale = length * pool_.factor_.inverse_scale();
  x = scale * column.cast<double>();
}

}  // namespace palpate::fem
