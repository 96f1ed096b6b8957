// SPDX-License-Identifier: AGPL-3.0-or-later
// Memory reused between the fronts of a factorization.
#pragma once

#include <limits>
#include <list>
#include <mutex>

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

  /// Scratch memory that the last factorization has left, of any size, for one of its threads.
  LargeVector<Number> take_scratch();
  void leave_scratch(LargeVector<Number>&& memory);

 private:
  LargeVector<Number> fitting(std::size_t numbers);

  std::mutex mutex_;
  double bound_ = std::numeric_limits<double>::infinity(),
         allocated_ = 0;  ///< bytes; of all large blocks, in use or spare
  std::list<LargeVector<Number>> spare_;
  LargeVector<Number> scratch_;
};

}  // namespace palpate::fem
