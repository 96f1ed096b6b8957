// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/large_pages.hpp"

#include <sys/mman.h>

namespace palpate::fem {

namespace {

constexpr std::size_t kLargePage = std::size_t{2} << 20;

}  // namespace

void* allocate_in_large_pages(std::size_t bytes) {
  if (bytes < kLargePagesFrom || bytes > static_cast<std::size_t>(-1) - kLargePage)
    return std::malloc(bytes);
  const std::size_t whole = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  void* memory = std::aligned_alloc(kLargePage, whole);
  if (memory) madvise(memory, whole, MADV_HUGEPAGE);  // advice: nothing is lost when it is declined
  return memory;
}

}  // namespace palpate::fem
