// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/live_session.hpp"

#include <chrono>
#include <exception>
#include <thread>

namespace palpate::app {
namespace {

constexpr std::size_t kQueueRoom = 1 << 15;  // steps: 30 s at 1 kHz, in case the writer is delayed
constexpr double kGrace = 1;                 // s
constexpr auto kNap = std::chrono::milliseconds(5);

/// Takes the steps off the queue and writes them down, in a thread of its own, until the loop has
/// stopped or the disk refuses.
class RecordingThread {
 public:
  RecordingThread(runtime::StepQueue& queue, SessionRecorder& recorder)
      : queue_(queue), recorder_(recorder), thread_([this] { write_down(); }) {}
  ~RecordingThread() { finish(); }
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  bool failed() const noexcept { return failed_; }
  /// After the loop has stopped. @return what the disk refused.
  std::optional<Error> finish() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return failure_;
  }

 private:
  void write_down() {
    try {
      while (!stop_) {
        drain();
        recorder_.breathe();
        std::this_thread::sleep_for(kNap);
      }
      drain();
    } catch (const Error& error) {
      failure_ = error;
    } catch (const std::exception& error) {
      failure_.emplace(ErrorKind::Internal, recorder_.journal().string(), error.what(),
                       "free some memory");
    }
    failed_ = failure_.has_value();
  }
  void drain() {
    RecordedStep step;
    while (queue_.try_dequeue(step)) recorder_.add(step);
  }

  runtime::StepQueue& queue_;
  SessionRecorder& recorder_;
  std::optional<Error> failure_;
  std::atomic<bool> stop_{false}, failed_{false};
  std::thread thread_;
};

/// The loop ends by itself when its time is over, unless the thread of a driver does not call it.
void wait_for_the_end(const runtime::LoopThread& thread, const runtime::ForceLoop& loop,
                      const RecordingThread& recording, double duration,
                      const std::atomic<bool>& stop) {
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double> most(duration + kGrace);
  std::optional<Clock::time_point> start;
  while (thread.running() && !recording.failed() && !stop) {
    if (!start && loop.heartbeat() != 0) start = Clock::now();
    if (duration > 0 && start && Clock::now() - *start >= most) return;
    std::this_thread::sleep_for(kNap);
  }
}

}  // namespace

void set_watchdog(LiveSettings& live, std::optional<double> watchdog) {
  live.safety.period = 1 / live.loop.rate;
  live.safety.watchdog = watchdog.value_or(runtime::default_watchdog(live.loop.rate));
  live.loop.watchdog = live.safety.watchdog;
}

SessionSettings session_settings(const LiveSettings& live) {
  SessionSettings settings;
  settings.tank_cap = live.contact.tank_cap;
  settings.lipschitz_bound = live.contact.lipschitz_bound;
  settings.search_rate = live.search_rate;
  settings.body_position = live.pose.position;
  settings.guarded = true;
  settings.ramp = live.safety.ramp;
  settings.watchdog = live.safety.watchdog;
  settings.max_force = live.safety.max_force;
  settings.max_speed = live.safety.max_speed;
  return settings;
}

LiveOutcome run_live(runtime::Device& device, const palpate_library& body,
                     const LiveSettings& settings, SessionRecorder& recorder,
                     const std::atomic<bool>& stop) {
  palpate_state state(body, settings.contact, settings.search_rate);
  state.set_pose(settings.pose);
  runtime::StepQueue queue(kQueueRoom);
  runtime::ForceLoop loop(device, state, settings.safety, &queue);
  LiveOutcome outcome;
  {
    RecordingThread recording(queue, recorder);
    runtime::LoopThreadSettings timing = settings.loop;
    timing.duration = settings.duration;
    runtime::LoopThread thread(loop, device, timing);
    wait_for_the_end(thread, loop, recording, settings.duration, stop);
    thread.stop();
    device.close();
    outcome.missing_rights = thread.missing_rights();
    outcome.halted = thread.halted();
    outcome.not_recorded = recording.finish();
  }
  outcome.counts = loop.counts();
  return outcome;
}

}  // namespace palpate::app
