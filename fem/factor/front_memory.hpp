// SPDX-License-Identifier: AGPL-3.0-or-later
// Memory that goes from front to front of a factorization.
#pragma once

#include <list>
#include <mutex>

#include "fem/factor/large_pages.hpp"

namespace palpate::fem {

/// What fronts that are done have left is taken again by those to come: the system clears every
/// page that it hands out. Spare memory is given back before more than `bound` bytes are in use.
/// Any thread may call it.
class FrontMemory {
 public:
  explicit FrontMemory(double bound) : bound_(bound) {}

  /// `numbers` zeros. @throws std::bad_alloc
  LargeVector<double> zeros(std::size_t numbers);
  void give_back(LargeVector<double>&& memory);

 private:
  LargeVector<double> fitting(std::size_t numbers);

  std::mutex mutex_;
  double bound_, held_ = 0;  ///< bytes; of all large ones that were handed out or are spare
  std::list<LargeVector<double>> spare_;
};

}  // namespace palpate::fem
