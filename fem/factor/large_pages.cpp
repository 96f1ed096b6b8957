// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/large_pages.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace palpate::fem {

namespace {

constexpr std::size_t kLargePage = std::size_t{2} << 20;
constexpr std::size_t kMost = static_cast<std::size_t>(-1) - 2 * kLargePage;

std::size_t rounded_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

std::size_t page() {
  static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return size;
}

}  // namespace

void* allocate_in_large_pages(std::size_t bytes) {
  if (bytes < kLargePagesFrom || bytes > kMost) return std::malloc(bytes);
  const std::size_t whole = rounded_up(bytes, kLargePage);
  void* memory = std::aligned_alloc(kLargePage, whole);
  if (memory) madvise(memory, whole, MADV_HUGEPAGE);  // advice: harmless when declined
  return memory;
}

void* map_pages(std::size_t bytes) {
  if (bytes > kMost) return nullptr;
  const std::size_t whole = rounded_up(bytes, page()), mapped = whole + kLargePage;
  void* memory = mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return nullptr;
  char* const start = static_cast<char*>(memory);
  const std::size_t before =
      (kLargePage - reinterpret_cast<std::uintptr_t>(start) % kLargePage) % kLargePage;
  if (before > 0) munmap(start, before);
  munmap(start + before + whole, kLargePage - before);
  madvise(start + before, whole, MADV_HUGEPAGE);
  return start + before;
}

void unmap_pages(void* memory, std::size_t bytes) noexcept {
  munmap(memory, rounded_up(bytes, page()));
}

}  // namespace palpate::fem
