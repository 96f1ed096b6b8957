// SPDX-License-Identifier: Apache-2.0
// The search thread of a build without threads, in place of search_thread.cpp.
#include "format/error.hpp"
#include "runtime/search_thread.hpp"

namespace palpate::runtime {

struct SearchThread::Worker {};

SearchThread::SearchThread(const Surface&, const CollisionTree&, double) {
  refuse("search_rate", "needs a thread, and this build has none", "set it to 0");
}

SearchThread::~SearchThread() = default;

void SearchThread::report(const TipReport&) noexcept {}

bool SearchThread::receive(Delivery&) noexcept {
  return false;
}

}  // namespace palpate::runtime
