// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/record/depth_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "format/number_text.hpp"
#include "runtime/palpate.h"

namespace palpate::app {

void DepthWatch::see(const RecordedStep& step) {
  contact_ += (step.status & PALPATE_CONTACT) != 0 ? 1 : 0;
  beyond_ += (step.status & PALPATE_BEYOND_DEPTH) != 0 ? 1 : 0;
  deepest_ = std::max(deepest_, step.depth);
}

std::string DepthWatch::warning(double known, const std::string& remedy) const {
  if (beyond_ == 0) return {};
  return fmt::format(
      "{} of {} steps in contact went beyond the deepest sample: their forces are extrapolated, "
      "not computed; every response is known to {}, the deepest step is {}; {}",
      beyond_, contact_, length_text(known), length_text(deepest_), remedy);
}

}  // namespace palpate::app
