// SPDX-License-Identifier: Apache-2.0
#include "runtime/search_thread.hpp"

#include <chrono>
#include <cstddef>

namespace palpate::runtime {

// Every access is atomic, so there is no race to define away; release and acquire on the values
// keep them between the two writes of the sequence, as a fence would.
void LatestReport::write(const TipReport& report) noexcept {
  const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
  sequence_.store(sequence + 1, std::memory_order_relaxed);
  for (std::size_t i = 0; i < 3; ++i) {
    position_[i].store(report.position[i], std::memory_order_release);
  }
  element_.store(report.element, std::memory_order_release);
  sequence_.store(sequence + 2, std::memory_order_release);
}

bool LatestReport::read(TipReport& report) noexcept {
  const std::uint64_t before = sequence_.load(std::memory_order_acquire);
  if (before % 2 == 1 || before == read_) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    report.position[i] = position_[i].load(std::memory_order_acquire);
  }
  report.element = element_.load(std::memory_order_acquire);
  if (sequence_.load(std::memory_order_relaxed) != before) return false;
  read_ = before;
  return true;
}

SearchThread::SearchThread(const Surface& surface, const CollisionTree& tree, double rate)
    : search_(surface, tree), thread_([this, rate] { run(rate); }) {}

SearchThread::~SearchThread() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

bool SearchThread::receive(Delivery& delivery) noexcept {
  bool received = false;
  while (queue_.try_dequeue(delivery)) received = true;
  return received;
}

void SearchThread::run(double rate) {
  using Clock = std::chrono::steady_clock;
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate));
  auto next = Clock::now();
  std::unique_lock lock(mutex_);
  while (!stop_) {
    TipReport tip;
    if (latest_.read(tip)) queue_.try_enqueue(search_.look(tip));  // full: the loop does not step
    next += period;
    wake_.wait_until(lock, next, [this] { return stop_; });
  }
}

}  // namespace palpate::runtime
