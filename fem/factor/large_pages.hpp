// SPDX-License-Identifier: AGPL-3.0-or-later
// Memory in large pages, for large arrays that are read from end to end repeatedly.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace palpate::fem {

/// Blocks of at least this many bytes are requested in large pages.
inline constexpr std::size_t kLargePagesFrom = std::size_t{32} << 20;
/// A LargeVector of at least this many bytes has pages of its own.
inline constexpr std::size_t kMappedFrom = std::size_t{1} << 20;

/// A replacement for std::malloc; std::free and std::realloc accept its blocks. Large blocks start
/// at a large page and the system is asked to use such pages for them (madvise, "huge pages" of
/// Linux): filling a factor of hundreds of megabytes then takes hundreds of page faults instead of
/// a hundred thousand, and reading it few TLB misses. Where the system declines, the memory is
/// ordinary.
void* allocate_in_large_pages(std::size_t bytes);

/// Pages mapped from the system, aligned to a large page. Unmapping returns them at once, whatever
/// was allocated since. Null when memory runs out.
void* map_pages(std::size_t bytes);
void unmap_pages(void* memory, std::size_t bytes) noexcept;

/// The memory of a LargeVector.
template <class T>
struct LargePages {
  using value_type = T;

  LargePages() = default;
  template <class U>
  explicit(false) LargePages(const LargePages<U>&) {}

  /// @throws std::bad_alloc
  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_alloc();
    const std::size_t bytes = count * sizeof(T);
    void* memory = bytes >= kMappedFrom ? map_pages(bytes) : std::malloc(bytes);
    if (!memory) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    if (count * sizeof(T) >= kMappedFrom)
      unmap_pages(memory, count * sizeof(T));
    else
      std::free(memory);
  }
  /// Default-initialized: the memory is first touched by the thread that uses it.
  template <class U>
  void construct(U* object) {
    ::new (static_cast<void*>(object)) U;
  }
  template <class U, class... Arguments>
  void construct(U* object, Arguments&&... arguments) {
    ::new (static_cast<void*>(object)) U(std::forward<Arguments>(arguments)...);
  }

  bool operator==(const LargePages&) const = default;
};

/// resize() leaves new elements uninitialized.
template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace palpate::fem
