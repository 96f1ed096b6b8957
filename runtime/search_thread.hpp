// SPDX-License-Identifier: Apache-2.0
// The search in a thread of its own, at a low rate.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "runtime/delivery.hpp"
#include "runtime/search.hpp"

namespace palpate::runtime {

/// The latest report of one writer for one reader. Neither waits for the other: a read during a
/// write returns nothing.
class LatestReport {
 public:
  void write(const TipReport& report) noexcept;
  /// False when there is no report newer than the last one read, or it is being written.
  bool read(TipReport& report) noexcept;

 private:
  std::atomic<std::uint64_t> sequence_{0};  ///< odd while a report is being written
  std::array<std::atomic<double>, 3> position_{};
  std::atomic<std::int32_t> element_{kNoElement};
  std::uint64_t read_ = 0;  ///< sequence of the last report read
};

/// The force loop reports the position of the tip and receives the triangles near it, which the
/// thread finds. Deliveries pass through a bounded queue without locks [Mahvash & Hayward 2005,
/// VI-A]. A build without threads has no_search_thread.cpp in place of search_thread.cpp.
class SearchThread {
 public:
  /// Starts the thread. rate: searches per second, Hz, > 0. @throws std::system_error; in a build
  /// without threads Error(Configuration).
  SearchThread(const Surface& surface, const CollisionTree& tree, double rate);
  ~SearchThread();  ///< stops the thread and waits for it
  SearchThread(const SearchThread&) = delete;
  SearchThread& operator=(const SearchThread&) = delete;

  /// Force loop only. Wait-free, no system call.
  void report(const TipReport& tip) noexcept;
  /// Force loop only: the newest delivery, if there is one. Wait-free, no system call.
  bool receive(Delivery& delivery) noexcept;

 private:
  struct Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace palpate::runtime
