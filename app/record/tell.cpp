// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/record/tell.hpp"

#include "app/console.hpp"

namespace palpate::app {

void tell(const Recovered& recovered) {
  say("recover: {} steps of a session that was cut off -> {}", recovered.steps,
      recovered.recording.string());
  if (recovered.dropped_bytes > 0)
    say("  {} bytes of a record cut short were dropped", recovered.dropped_bytes);
}

void tell_what_was_left(const std::filesystem::path& recording) {
  if (const auto recovered = recover_what_was_left(recording)) tell(*recovered);
}

}  // namespace palpate::app
