// SPDX-License-Identifier: AGPL-3.0-or-later
// Memory in large pages, for what is read from end to end again and again.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace palpate::fem {

/// From this many bytes on memory is asked for in large pages.
inline constexpr std::size_t kLargePagesFrom = std::size_t{32} << 20;
/// From this many bytes on a LargeVector has pages of its own.
inline constexpr std::size_t kMappedFrom = std::size_t{1} << 20;

/// As std::malloc, of which it is but another form: std::free and std::realloc take it back. Large
/// blocks start at a large page and the system is asked to use such pages for them (madvise, "Huge
/// pages" of Linux): a factor of hundreds of megabytes then costs hundreds of page faults to make,
/// not a hundred thousand, and its reading few misses of the address cache. Where the system
/// declines, the memory is ordinary; the numbers in it are the same.
void* allocate_in_large_pages(std::size_t bytes);

/// Pages of the system's own, the first a large one: what is given back is the system's again at
/// once, whatever was allocated since. Null when there is none.
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
  /// Numbers that nothing is said of have no value: their memory is first touched where it is used.
  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

  bool operator==(const LargePages&) const = default;
};

/// resize() leaves new numbers undefined.
template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace palpate::fem
