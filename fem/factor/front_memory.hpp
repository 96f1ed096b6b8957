// SPDX-License-Identifier: AGPL-3.0-or-later
// Memory reused between the fronts of a factorization.
#pragma once

#include <limits>
#include <list>
#include <mutex>
#include <vector>

#include "fem/factor/large_pages.hpp"

namespace palpate::fem {

/// A pool for the updates of fronts: pages that the system hands out anew are cleared first, which
/// costs time. Thread-safe. For numbers of single and of double precision.
template <class Number>
class FrontMemory {
 public:
  /// Spare memory is freed before more than `bytes` are in use; without this call never.
  void keep_at_most(double bytes) { bound_ = bytes; }

  /// `numbers` zeros. @throws std::bad_alloc
  LargeVector<Number> zeros(std::size_t numbers);
  void give_back(LargeVector<Number>&& memory);

  /// The largest scratch memory that threads of factorizations have left; empty without any.
  LargeVector<Number> take_scratch();
  void leave_scratch(LargeVector<Number>&& memory);

 private:
  LargeVector<Number> fitting(std::size_t numbers);

  std::mutex mutex_;
  double bound_ = std::numeric_limits<double>::infinity(),
         allocated_ = 0;  ///< bytes; of all large blocks, in use or spare
  std::list<LargeVector<Number>> spare_;
  std::vector<LargeVector<Number>> scratch_;
};

/// The memory that the factorizations of many matrices share, one at a time on each thread.
struct SharedFronts {
  FrontMemory<float> in_single;
  FrontMemory<double> in_double;

  template <class Number>
  FrontMemory<Number>& of();
};
template <>
inline FrontMemory<float>& SharedFronts::of() {
  return in_single;
}
template <>
inline FrontMemory<double>& SharedFronts::of() {
  return in_double;
}

}  // namespace palpate::fem
