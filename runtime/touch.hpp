// SPDX-License-Identifier: Apache-2.0
// The contact as a picture of it needs it, and its way from the force loop to another thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "format/vec3.hpp"
#include "runtime/pose.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// The contact after a step, in the frame of the body, and the pose of the body.
struct Touch {
  SurfacePoint point;    ///< without an element: no contact
  Vec3 contact_point{};  ///< c, m
  Vec3 normal{};         ///< n, unit, into the body
  double depth = 0;      ///< n . (x - c), m: of the tip below the surface at rest
  Vec3 lateral{};        ///< m: of the tip from the anchor, across n
  Vec3 shear{};          ///< m: by how much a tool without friction slides as it is pressed
  Vec3 tip{};            ///< x, m
  Pose pose;
};
static_assert(std::is_trivially_copyable_v<Touch>);

/// Hands the last Touch to other threads. publish() belongs to one thread and is wait-free: it
/// never waits for a reader. read() may be called from any number of threads; it repeats itself
/// where a publication overtakes it, so that a Touch is always of one step. Allocation-free.
class PublishedTouch {
 public:
  PublishedTouch() noexcept { publish({}); }

  void publish(const Touch& touch) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &touch, sizeof touch);
    const std::uint64_t before = sequence_.load(std::memory_order_relaxed);
    sequence_.store(before + 1, std::memory_order_relaxed);  // odd: being written
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    sequence_.store(before + 2, std::memory_order_release);
  }

  Touch read() const noexcept {
    for (;;) {
      std::array<std::uint64_t, kWords> words{};
      const std::uint64_t before = sequence_.load(std::memory_order_acquire);
      for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
      if (before % 2 != 0 || sequence_.load(std::memory_order_relaxed) != before) continue;
      Touch touch;
      std::memcpy(static_cast<void*>(&touch), words.data(), sizeof touch);
      return touch;
    }
  }

 private:
  static constexpr std::size_t kWords = (sizeof(Touch) + 7) / 8;
  std::atomic<std::uint64_t> sequence_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace palpate::runtime
