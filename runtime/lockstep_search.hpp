// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "runtime/contact_state.hpp"
#include "runtime/search.hpp"

namespace palpate::runtime {

/// The search at a low rate without a thread, for reproducible simulations: it runs in every
/// `period`-th step of the force loop, and its delivery arrives with the next run, as late as that
/// of a thread of this rate can be.
class LockstepSearch {
 public:
  LockstepSearch(const Surface& surface, const CollisionTree& tree, int period,
                 std::size_t most = Delivery::kMost)
      : search_(surface, tree, most), period_(period) {}
  LockstepSearch(const LockstepSearch&) = delete;  // the contact points into it
  LockstepSearch& operator=(const LockstepSearch&) = delete;

  /// One step of the force loop at tip position x; the contact must use this search only.
  std::uint32_t step(ContactState& contact, const Vec3& x, double dt = 0) {
    const bool looks = steps_++ % period_ == 0;
    if (looks) {
      delivered_ = found_;
      contact.set_delivery(&delivered_);
    }
    const std::uint32_t status = contact.step(x, dt);
    if (looks) found_ = search_.look({x, contact.observation().point.element});
    return status;
  }

 private:
  Search search_;
  int period_;
  long steps_ = 0;
  Delivery delivered_, found_;
};

}  // namespace palpate::runtime
