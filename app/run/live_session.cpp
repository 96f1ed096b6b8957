// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/live_session.hpp"

#include <chrono>
#include <memory>
#include <thread>

namespace palpate::app {
namespace {

constexpr std::size_t kQueueRoom = 1 << 15;  // steps: 30 s at 1 kHz, should the writer be held up
constexpr auto kNap = std::chrono::milliseconds(5);

/// Takes the steps off the queue until the loop has stopped, in a thread of its own.
class Collector {
 public:
  explicit Collector(runtime::StepQueue& queue) : queue_(queue), thread_([this] { collect(); }) {}
  ~Collector() { finish(); }
  Collector(const Collector&) = delete;
  Collector& operator=(const Collector&) = delete;

  /// All that was recorded; the loop has stopped.
  std::vector<RecordedStep> finish() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return std::move(steps_);
  }

 private:
  void collect() {
    while (!stop_) {
      drain();
      std::this_thread::sleep_for(kNap);
    }
    drain();
  }
  void drain() {
    RecordedStep step;
    while (queue_.try_dequeue(step)) steps_.push_back(step);
  }

  runtime::StepQueue& queue_;
  std::vector<RecordedStep> steps_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void wait_for_the_end(const runtime::LoopThread& loop, double duration,
                      const std::atomic<bool>& stop) {
  const auto start = std::chrono::steady_clock::now();
  const std::chrono::duration<double> most(duration);
  while (loop.running() && !stop) {
    if (duration > 0 && std::chrono::steady_clock::now() - start >= most) return;
    std::this_thread::sleep_for(kNap);
  }
}

}  // namespace

SessionSettings session_settings(const LiveSettings& live) {
  SessionSettings settings;
  settings.tank_cap = live.contact.tank_cap;
  settings.steepness = live.contact.steepness;
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
                     const LiveSettings& settings, const std::atomic<bool>& stop) {
  palpate_state state(body, settings.contact, settings.search_rate);
  state.pose = settings.pose;
  runtime::StepQueue queue(kQueueRoom);
  runtime::ForceLoop loop(device, state, settings.safety, &queue);
  device.open();
  LiveOutcome outcome;
  {
    Collector collector(queue);
    runtime::LoopThread thread(loop, device, settings.loop);
    wait_for_the_end(thread, settings.duration, stop);
    thread.stop();
    device.close();
    outcome.missing_rights = thread.missing_rights();
    outcome.halted = thread.halted();
    outcome.steps = collector.finish();
  }
  outcome.counts = loop.counts();
  return outcome;
}

}  // namespace palpate::app
