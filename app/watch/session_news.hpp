// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "format/recording.hpp"

namespace palpate::app {

/// What has become known of running sessions since one asked last.
struct SessionNews {
  std::optional<RecordingHeading> begun;  ///< a session began
  std::vector<RecordedStep> steps;        ///< of it
  bool ended = false;
};

/// Steps that are taken at once: the rest comes with the next news.
inline constexpr std::size_t kMostNews = 1 << 15;

}  // namespace palpate::app
