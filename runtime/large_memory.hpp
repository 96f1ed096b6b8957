// SPDX-License-Identifier: Apache-2.0
// Memory for large tables that are read at random places.
#pragma once

#if defined(__linux__)
#include <sys/mman.h>
#elif defined(_WIN32)
#include <malloc.h>
#endif

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

namespace palpate::runtime {

/// Allocator for std::vector that requests large pages where the table is large: in a table of 100
/// MB a miss of the page cache costs more than the read. A system without large pages ignores it.
template <class T>
struct LargeMemory {
  using value_type = T;
  LargeMemory() = default;
  template <class U>
  LargeMemory(const LargeMemory<U>&) noexcept {}  // NOLINT: allocators convert

  T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T) - kPage) throw std::bad_alloc();
    const std::size_t bytes = count * sizeof(T);
    const std::size_t alignment = bytes < 2 * kPage ? kLine : kPage;
    const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
#if defined(_WIN32)
    void* memory = _aligned_malloc(whole, alignment);
#else
    void* memory = std::aligned_alloc(alignment, whole);
#endif
    if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__)
    if (alignment == kPage) madvise(memory, whole, MADV_HUGEPAGE);  // optional
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) noexcept {
#if defined(_WIN32)
    _aligned_free(memory);
#else
    std::free(memory);
#endif
  }
  bool operator==(const LargeMemory&) const = default;

 private:
  static constexpr std::size_t kPage = std::size_t{1} << 21;  // bytes
  static constexpr std::size_t kLine = 64;                    // bytes
};

}  // namespace palpate::runtime
