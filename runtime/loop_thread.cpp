// SPDX-License-Identifier: Apache-2.0
#include "runtime/loop_thread.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "format/error.hpp"
#include "runtime/settings_check.hpp"

namespace palpate::runtime {
namespace {

constexpr double kMostRate = 100000;   // Hz
constexpr double kMostDuration = 1e9;  // s: in ns it fits 64 bits

}  // namespace

LoopThread::LoopThread(LoopBody& loop, Device& device, const LoopThreadSettings& settings)
    : loop_(loop), device_(device), settings_(settings) {
  const SettingsCheck require("force loop");
  require(settings.rate > 0 && settings.rate <= kMostRate, "rate (Hz)", settings.rate,
          "1 to 100000");
  require(std::isfinite(settings.watchdog) && settings.watchdog > 0, "watchdog (s)",
          settings.watchdog, "a finite value above 0");
  require(settings.duration >= 0 && settings.duration <= kMostDuration, "duration (s)",
          settings.duration, "0 (until it is stopped) to 1e9");
  require(settings.wake_early >= 0 &&
              settings.wake_early * settings.rate <= LoopThreadSettings::kMostEarly,
          "wake_early (s)", settings.wake_early, "0 to 0.8 periods of the loop");
  if (settings.wake_early > 0 && device.has_own_thread())
    throw Error(ErrorKind::Configuration, "force loop",
                "the driver of " + device.name() + " calls the loop at its own times",
                "leave out the early wake");
  period_ = std::llround(1e9 / settings.rate);
  early_ = std::llround(1e9 * settings.wake_early);
  if (device.has_own_thread()) {
    device.start_calls([this] { return foreign_step(); });
  } else {
    thread_ = std::thread([this] { run(); });
  }
  watchdog_ = std::thread([this] { watch(); });
}

LoopThread::~LoopThread() {
  stop();
}

void LoopThread::stop() noexcept {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  if (device_.has_own_thread()) device_.stop_calls();
  if (watchdog_.joinable()) watchdog_.join();
  if (running_.exchange(false)) finish();
}

std::string LoopThread::missing_rights() const {
  const std::scoped_lock lock(mutex_);
  return missing_;
}

/// The time counts from the first step: locking the memory before it takes a while.
void LoopThread::begin(std::int64_t first_due) noexcept {
  due_ = first_due;
  const auto periods = std::llround(settings_.duration * settings_.rate);
  end_ = settings_.duration > 0 ? first_due + periods * period_
                                : std::numeric_limits<std::int64_t>::max();
}

void LoopThread::run() {
  std::string missing = become_realtime(settings_.realtime);
  {
    const std::scoped_lock lock(mutex_);
    missing_ = std::move(missing);
  }
  begin(monotonic_ns() + period_);
  while (!stop_ && due_ < end_) {
    wait_until(due_, early_);
    if (!loop_.tick(due_)) break;
    due_ += period_;
    const std::int64_t now = monotonic_ns();
    if (now <= due_) continue;
    const std::int64_t missed = (now - due_ + period_ - 1) / period_;
    loop_.count_overrun(std::min(missed, (end_ - due_) / period_));
    due_ += missed * period_;
  }
  finish();
  running_ = false;
}

/// A step from the thread of the driver, which keeps its own time: due one period after the last.
bool LoopThread::foreign_step() noexcept {
  const std::int64_t now = monotonic_ns();
  if (due_ == 0) {
    begin(now);
  } else {
    due_ = std::min(due_ + period_, now);
  }
  if (!stop_ && now < end_ - period_ / 2 && loop_.tick(due_)) return true;
  finish();
  running_ = false;
  return false;
}

void LoopThread::finish() noexcept {
  device_.command({});
}

void LoopThread::watch() {
  const auto limit = std::llround(1e9 * settings_.watchdog);
  const auto nap = std::chrono::nanoseconds(std::max<std::int64_t>(limit / 4, 100'000));
  std::unique_lock lock(mutex_);
  while (!stop_ && running_) {
    wake_.wait_for(lock, nap, [this] { return stop_.load(); });
    // Before the first step nothing has been commanded; locking memory for it may take a while.
    const std::int64_t beat = loop_.heartbeat();
    if (stop_ || !running_ || beat == 0 || monotonic_ns() - beat <= limit) continue;
    device_.halt();
    halted_ = true;
  }
}

}  // namespace palpate::runtime
