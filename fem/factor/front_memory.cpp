// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/front_memory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::fem {

namespace {

/// Numbers from which a block is pooled; the allocator itself reuses smaller ones.
constexpr std::size_t kLarge = std::size_t{1} << 17;
/// Largest size of a spare block that is reused, over the size requested, where memory is bounded.
constexpr std::size_t kMostWaste = 2;

template <class Number>
double bytes_of(const LargeVector<Number>& memory) {
  return sizeof(Number) * static_cast<double>(memory.capacity());
}

}  // namespace

/// The smallest spare block that fits without waste; empty when there is none.
template <class Number>
LargeVector<Number> FrontMemory<Number>::fitting(std::size_t numbers) {
  const std::lock_guard lock(mutex_);
  const std::size_t largest =
      std::isfinite(bound_) ? kMostWaste * numbers : static_cast<std::size_t>(-1);
  auto best = spare_.end();
  for (auto each = spare_.begin(); each != spare_.end(); ++each)
    if (each->capacity() >= numbers && each->capacity() <= largest &&
        (best == spare_.end() || each->capacity() < best->capacity()))
      best = each;
  if (best != spare_.end()) {
    LargeVector<Number> found = std::move(*best);
    spare_.erase(best);
    return found;
  }
  const double needed = sizeof(Number) * static_cast<double>(numbers);
  while (!spare_.empty() && allocated_ + needed > bound_) {
    allocated_ -= bytes_of(spare_.front());
    spare_.pop_front();
  }
  allocated_ += needed;
  return {};
}

template <class Number>
LargeVector<Number> FrontMemory<Number>::zeros(std::size_t numbers) {
  LargeVector<Number> memory;
  if (numbers >= kLarge) memory = fitting(numbers);
  memory.assign(numbers, Number{0});
  return memory;
}

template <class Number>
void FrontMemory<Number>::give_back(LargeVector<Number>&& memory) {
  LargeVector<Number> mine = std::move(memory);
  if (mine.capacity() < kLarge) return;
  const std::lock_guard lock(mutex_);
  spare_.push_back(std::move(mine));
}

template <class Number>
LargeVector<Number> FrontMemory<Number>::take_scratch() {
  const std::lock_guard lock(mutex_);
  if (scratch_.empty()) return {};
  const auto largest =
      std::max_element(scratch_.begin(), scratch_.end(),
                       [](const auto& a, const auto& b) { return a.capacity() < b.capacity(); });
  std::swap(*largest, scratch_.back());
  LargeVector<Number> left = std::move(scratch_.back());
  scratch_.pop_back();
  return left;
}

template <class Number>
void FrontMemory<Number>::leave_scratch(LargeVector<Number>&& memory) {
  LargeVector<Number> mine = std::move(memory);
  const std::lock_guard lock(mutex_);
  scratch_.push_back(std::move(mine));
}

template class FrontMemory<float>;
template class FrontMemory<double>;

}  // namespace palpate::fem
