// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/record/session_recorder.hpp"

#include <system_error>
#include <utility>

#include "format/error.hpp"
#include "format/record_file.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWaiting = 4096;             // steps: 700 kB
constexpr std::chrono::milliseconds kLongestWait{30};  // what watches the journal sees it move
constexpr std::chrono::seconds kSynchronizeEvery{1};

/// The first `<stem>.recovered-<n>.h5` that is free.
fs::path free_name(const fs::path& recording) {
  for (int n = 1;; ++n) {
    fs::path name = recording;
    name.replace_filename(recording.stem().string() + ".recovered-" + std::to_string(n) +
                          recording.extension().string());
    if (!fs::exists(name)) return name;
  }
}

/// <journal>.damaged, or the first <journal>.damaged-<n> that is free.
fs::path name_for_damaged(const fs::path& journal) {
  const std::string name = journal.string() + ".damaged";
  if (!fs::exists(name)) return name;
  for (int n = 2;; ++n) {
    fs::path numbered = name + "-" + std::to_string(n);
    if (!fs::exists(numbered)) return numbered;
  }
}

/// A stage that ends now, of this build, without inputs of its own.
std::string now() {
  return make_provenance_step("now", "", {}).utc;
}

}  // namespace

void throw_with_journal(const Error& error, const fs::path& journal) {
  throw Error(error.kind(), error.where(), error.problem(),
              error.remedy() + "; the steps are in the journal: `palpate recover " +
                  journal.string() + "` makes the recording of them");
}

fs::path journal_of(const fs::path& recording) {
  fs::path journal = recording;
  return journal.replace_extension(".journal");
}

Recovered recover(const fs::path& journal, const fs::path& recording) {
  const SessionSummary summary = summarize_session(journal);
  RecordFile locked(journal, "the session is still running", "wait until it ends");
  Provenance provenance = summary.heading.provenance;
  provenance.steps.push_back(make_provenance_step(
      "recover", "", {},
      {{"dropped_bytes", std::to_string(summary.incomplete_bytes)},
       {"reason", "the session was interrupted; these are the steps of its journal"}}));
  for (const JournalGap& gap : summary.gaps)
    provenance.steps.back().facts.emplace_back("gap", gap_text(gap));
  Recovered result{recording, 0, summary.incomplete_bytes, summary.gaps, {}};
  result.steps = write_recording_of(journal, recording, provenance);
  if (result.gaps.empty()) {
    locked.remove();
  } else {
    result.kept_journal = name_for_damaged(journal);
    locked.rename(result.kept_journal);
  }
  return result;
}

std::optional<Recovered> recover_interrupted(const fs::path& recording) {
  const fs::path journal = journal_of(recording);
  std::error_code ignored;
  if (!fs::exists(journal, ignored) || !holds_session(journal)) return {};
  return recover(journal, free_name(recording));
}

SessionRecorder::SessionRecorder(fs::path recording, const RecordingHeading& heading)
    : recording_(std::move(recording)),
      provenance_(heading.provenance),
      journal_(journal_of(recording_), heading) {
  waiting_.reserve(kMostWaiting);
}

void SessionRecorder::add(const RecordedStep& step) {
  depths_.see(step);
  waiting_.push_back(step);
  if (waiting_.size() == kMostWaiting) write_waiting();
}

void SessionRecorder::breathe() {
  if (!waiting_.empty() && Clock::now() - written_ >= kLongestWait) write_waiting();
}

void SessionRecorder::write_waiting() {
  journal_.append(waiting_);
  waiting_.clear();
  written_ = Clock::now();
  if (written_ - synchronized_ < kSynchronizeEvery) return;
  journal_.synchronize();
  synchronized_ = Clock::now();
}

void SessionRecorder::finish() {
  try {
    write_waiting();
    if (!provenance_.steps.empty()) provenance_.steps.back().utc = now();
    write_recording_of(journal_.path(), recording_, provenance_);
  } catch (const Error& error) {
    throw_with_journal(error, journal_.path());
  }
  journal_.remove();
}

}  // namespace palpate::app
