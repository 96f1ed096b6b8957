// SPDX-License-Identifier: AGPL-3.0-or-later
// A recorded session once more, without device and clock.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "format/recording.hpp"
#include "runtime/handles.hpp"

namespace palpate::app {

/// The recorded motion through the model, with the settings of the recording: the steps as they
/// would be recorded now; latencies are those of the recording. The body is searched in every step.
Recording replay(const Recording& recorded, const palpate_library& body);

/// Where two recordings of the same motion part.
struct Difference {
  std::size_t step;
  std::string what;  ///< a column of recording.h5
  double recorded, replayed;
};

/// The first value that has not the same bits, latencies apart.
std::optional<Difference> first_difference(const Recording& recorded, const Recording& replayed);

/// @throws Error(Internal) that says what was the first difference and what can be behind it.
void require_same(const Recording& recorded, const Recording& replayed, const std::string& file);

}  // namespace palpate::app
