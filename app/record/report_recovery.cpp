// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/record/report_recovery.hpp"

#include "app/console.hpp"

namespace palpate::app {

void report(const Recovered& recovered) {
  say("recover: {} steps of an interrupted session -> {}", recovered.steps,
      recovered.recording.string());
  if (recovered.dropped_bytes > 0)
    say("  {} bytes of an incomplete record were dropped", recovered.dropped_bytes);
  if (recovered.gaps.empty()) return;
  for (const JournalGap& gap : recovered.gaps)
    warn("the journal is damaged: the recording lacks " + gap_text(gap));
  say("  the damaged journal is now {}", recovered.kept_journal.string());
}

void recover_and_report(const std::filesystem::path& recording) {
  if (const auto recovered = recover_interrupted(recording)) report(*recovered);
}

}  // namespace palpate::app
