// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/interruption.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <utility>

namespace palpate::app {
namespace {

constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};

/// The line for the signal handler, which may neither allocate nor wait: of two buffers one is
/// complete at any moment.
class Note {
 public:
  void set(const std::string& text) {
    const int spare = 1 - std::max(0, current_.load());
    auto& buffer = buffers_[static_cast<std::size_t>(spare)];
    std::strncpy(buffer.data(), text.c_str(), buffer.size() - 1);
    current_ = spare;
  }
  void clear() { current_ = -1; }
  /// Safe in a signal handler [signal-safety(7)].
  void write() const noexcept {
    const int current = current_;
    if (current < 0) return;
    const auto& buffer = buffers_[static_cast<std::size_t>(current)];
    [[maybe_unused]] const auto written =
        ::write(STDERR_FILENO, buffer.data(), std::strlen(buffer.data()));
  }

 private:
  std::array<std::array<char, 1024>, 2> buffers_{};
  std::atomic<int> current_{-1};
  static_assert(std::atomic<int>::is_always_lock_free);
};

Note note;

/// Writes the note and ends the process by the signal, as its parent expects.
extern "C" void end_with_note(int signal) {
  note.write();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void handle_signals(bool handled) {
  for (const int signal : kSignals) std::signal(signal, handled ? end_with_note : SIG_DFL);
}

/// What the note says during a campaign.
class CampaignNote {
 public:
  void see(const CampaignStarted& e) {
    journal_ = e.journal.string();
    note.set("\ninterrupted before the first site was finished\n");
    handle_signals(true);
  }
  void see(const Progress& e) {
    if (e.done > 0)
      note.set(
          fmt::format("\ninterrupted; {} of {} sites are kept in {}: run the same command to "
                      "go on\n",
                      e.done, e.total, journal_));
  }
  void see(const CampaignFinished&) {
    handle_signals(false);
    note.clear();
  }
  template <class Other>
  void see(const Other&) {}

 private:
  std::string journal_;
};

}  // namespace

EventSink with_interruption_note(EventSink sink) {
  return [sink = std::move(sink), campaign = CampaignNote()](const Event& event) mutable {
    std::visit([&campaign](const auto& e) { campaign.see(e); }, event);
    sink(event);
  };
}

}  // namespace palpate::app
