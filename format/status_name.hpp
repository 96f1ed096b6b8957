// SPDX-License-Identifier: Apache-2.0
// The words for states, as files, events and bindings say them.
#pragma once

#include <string_view>

#include "format/curves.hpp"

namespace palpate {

constexpr std::string_view status_name(SiteStatus status) {
  switch (status) {
    case SiteStatus::Complete:
      return "complete";
    case SiteStatus::Partial:
      return "partial";
    case SiteStatus::Failed:
      return "failed";
  }
  return {};
}

}  // namespace palpate
