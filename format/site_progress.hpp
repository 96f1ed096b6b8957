// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate {

/// A site that is being solved.
struct SiteProgress {
  std::int32_t vertex = -1;
  double fraction = 0;           ///< of its increments that are done
  double processor_seconds = 0;  ///< that these have taken
};

}  // namespace palpate
