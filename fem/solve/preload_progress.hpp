// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <functional>
#include <utility>

namespace palpate::fem {

/// How far the search for the equilibrium under the weight is.
struct PreloadProgress {
  int steps = 0;       ///< of Newton's method
  double carried = 0;  ///< part of the weight, 0 .. 1, of the last equilibrium
  int shapes = 0;      ///< that were tried as the shape without weight
};

/// Counts, and tells each change.
class PreloadCounter {
 public:
  using Tell = std::function<void(const PreloadProgress&)>;
  /// `tell` may be null.
  explicit PreloadCounter(Tell tell = {}) : tell_(std::move(tell)) {}

  void count_step() {
    ++now_.steps;
    tell();
  }
  void count_shape() {
    ++now_.shapes;
    tell();
  }
  void carry(double part) { now_.carried = part; }
  const PreloadProgress& now() const { return now_; }

 private:
  void tell() const {
    if (tell_) tell_(now_);
  }

  Tell tell_;
  PreloadProgress now_;
};

}  // namespace palpate::fem
