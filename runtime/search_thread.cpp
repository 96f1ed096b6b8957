// SPDX-License-Identifier: Apache-2.0
#include "runtime/search_thread.hpp"

#include <readerwriterqueue/readerwritercircularbuffer.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>

namespace palpate::runtime {

struct SearchThread::Worker {
  Worker(const Surface& surface, const CollisionTree& tree, double rate)
      : search(surface, tree), thread([this, rate] { run(rate); }) {}
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void run(double rate);

  Search search;
  LatestReport latest;
  moodycamel::BlockingReaderWriterCircularBuffer<Delivery> queue{4};
  std::mutex mutex;
  std::condition_variable wake;
  bool stop = false;
  std::thread thread;  ///< last member: it uses the others
};

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
    : worker_(std::make_unique<Worker>(surface, tree, rate)) {}

SearchThread::~SearchThread() = default;

void SearchThread::report(const TipReport& tip) noexcept {
  worker_->latest.write(tip);
}

bool SearchThread::receive(Delivery& delivery) noexcept {
  bool received = false;
  while (worker_->queue.try_dequeue(delivery)) received = true;
  return received;
}

SearchThread::Worker::~Worker() {
  {
    const std::scoped_lock lock(mutex);
    stop = true;
  }
  wake.notify_one();
  thread.join();
}

void SearchThread::Worker::run(double rate) {
  using Clock = std::chrono::steady_clock;
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate));
  auto next = Clock::now();
  std::unique_lock lock(mutex);
  while (!stop) {
    TipReport tip;
    if (latest.read(tip)) queue.try_enqueue(search.look(tip));  // full: the loop does not step
    next += period;
    wake.wait_until(lock, next, [this] { return stop; });
  }
}

}  // namespace palpate::runtime
