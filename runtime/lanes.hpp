// SPDX-License-Identifier: Apache-2.0
// Numbers of all relaxation times side by side, for arithmetic of two at a time.
#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "format/library.hpp"

namespace palpate::runtime {

/// Two numbers on which operators act one by one, with the roundings of single numbers on every
/// processor. A comparison of two Pairs is a Mask.
using Pair __attribute__((vector_size(16))) = double;
using Mask __attribute__((vector_size(16))) = std::int64_t;

constexpr Pair both(double x) noexcept {
  return Pair{x, x};
}
/// Comparisons that stay masks of the processor: those of the language, combined, become numbers
/// and masks again on the way to all().
inline Mask less(const Pair& a, const Pair& b) noexcept {
#ifdef __SSE2__
  return reinterpret_cast<Mask>(_mm_cmplt_pd(a, b));
#else
  return a < b;
#endif
}
inline Mask at_most(const Pair& a, const Pair& b) noexcept {
#ifdef __SSE2__
  return reinterpret_cast<Mask>(_mm_cmple_pd(a, b));
#else
  return a <= b;
#endif
}
inline bool all(const Mask& m) noexcept {
#ifdef __SSE2__
  return _mm_movemask_pd(reinterpret_cast<__m128d>(m)) == 3;  // two instructions
#else
  return (m[0] & m[1]) != 0;
#endif
}
/// The larger or the smaller of each, b where they are not ordered: one instruction.
inline Pair larger(const Pair& a, const Pair& b) noexcept {
  return a > b ? a : b;
}
inline Pair smaller(const Pair& a, const Pair& b) noexcept {
  return a < b ? a : b;
}
/// A sum and two more terms, added in their order.
inline double plus(double sum, const Pair& terms) noexcept {
  return sum + terms[0] + terms[1];
}
inline Pair roots(const Pair& x) noexcept {
  return Pair{std::sqrt(x[0]), std::sqrt(x[1])};
}

/// Pairs that hold a number of lanes.
constexpr std::size_t pairs_of(std::size_t lanes) noexcept {
  return (lanes + 1) / 2;
}

/// A number for each relaxation time of a library, and one more. Lanes that are not in use are 0
/// unless something else is said.
struct Lanes {
  static constexpr std::size_t kPairs = pairs_of(kMaxRelaxationTimes + 1);
  Pair pair[kPairs]{};

  double operator[](std::size_t i) const noexcept { return pair[i / 2][i % 2]; }
  /// Stores a whole pair: a pair of which one number has just been stored is slow to load.
  void set(std::size_t i, double x) noexcept {
    Pair& p = pair[i / 2];
    p = i % 2 == 0 ? Pair{x, p[1]} : Pair{p[0], x};
  }
};

}  // namespace palpate::runtime
