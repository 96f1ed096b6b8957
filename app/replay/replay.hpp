// SPDX-License-Identifier: AGPL-3.0-or-later
// Repeats a recorded session without device and clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "format/recording.hpp"
#include "runtime/handles.hpp"
#include "runtime/safety.hpp"

namespace palpate::app {

/// The recorded motion through the model, step after step, with the settings of the recording.
/// Latencies are those of the recording. The body is searched in every step.
class Replay {
 public:
  /// Both must outlive the replay.
  Replay(const RecordingHeading& recorded, const palpate_library& body);
  /// Repeats the next recorded step.
  RecordedStep step(const RecordedStep& recorded);

 private:
  palpate_state state_;
  std::optional<runtime::Safety> safety_;
  double period_ = 0;                 ///< s, of a session without a device
  std::optional<std::int64_t> last_;  ///< time of the last step, ns
};

/// All steps at once.
Recording replay(const Recording& recorded, const palpate_library& body);

/// A value in which two recordings of the same motion differ.
struct Difference {
  std::size_t step = 0;
  std::string what;  ///< a column of recording.h5
  double recorded = 0, replayed = 0;
};

/// The first value of a step whose bits differ, except the latency; `number`: of the step.
std::optional<Difference> difference(const RecordedStep& recorded, const RecordedStep& replayed,
                                     std::size_t number);
std::optional<Difference> first_difference(const Recording& recorded, const Recording& replayed);

/// @throws Error(Configuration) that names the difference and its possible causes.
[[noreturn]] void refuse_difference(const Difference& found, const RecordingHeading& recorded,
                                    const std::string& file);

}  // namespace palpate::app
