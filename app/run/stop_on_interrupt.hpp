// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>

namespace palpate::app {

/// While this object exists, SIGINT, SIGTERM and SIGHUP end the session instead of the process. One
/// at a time.
class StopOnInterrupt {
 public:
  StopOnInterrupt() {
    flag() = false;
    struct sigaction action {};
    action.sa_handler = [](int) { flag() = true; };
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
  }
  ~StopOnInterrupt() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  }
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

  const std::atomic<bool>& interrupted() const noexcept { return flag(); }

 private:
  static std::atomic<bool>& flag() noexcept {
    static std::atomic<bool> interrupted{false};
    return interrupted;
  }

  static constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_{};
};

}  // namespace palpate::app
