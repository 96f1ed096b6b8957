// SPDX-License-Identifier: AGPL-3.0-or-later
// A libHD for tests, written from the documented C interface: millimetres, calls only inside a
// frame, errors queued, and a servo thread of its own.
#include <chrono>
#include <deque>
#include <thread>

#include "tests/unit/runtime/devices/fake_world.hpp"

namespace {

constexpr unsigned kBadCall = 0x0102;
constexpr unsigned kCommunication = 0x0302;
constexpr unsigned kExceeded = 0x0200;

palpate::test::FakeWorld world;
std::mutex error_mutex;
std::deque<unsigned> errors;
thread_local bool in_frame = false;
unsigned (*callback)(void*) = nullptr;
void* user = nullptr;
std::thread servo;
std::atomic<bool> running{false};

void raise(unsigned code) {
  const std::scoped_lock lock(error_mutex);
  errors.push_back(code);
}

void serve() {
  while (running && callback != nullptr) {
    if (callback(user) == 0) break;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

}  // namespace

palpate::test::FakeWorld* fake_world() {
  return &world;
}

extern "C" {

struct HDErrorInfo {
  unsigned errorCode;
  int internalErrorCode;
  unsigned hHD;
};

unsigned hdInitDevice(const char* name) {
  if (world.present) {
    world.opened_name = name == nullptr ? "default" : name;
    ++world.opened;
    return 7;
  }
  raise(0x0301);
  return 0xFFFFFFFF;
}
void hdMakeCurrentDevice(unsigned handle) {
  if (handle != 7) raise(kBadCall);
}
void hdDisableDevice(unsigned) {
  ++world.closed;
}
void hdBeginFrame(unsigned) {
  world.wait_for_device();
  in_frame = true;
}
void hdEndFrame(unsigned) {
  in_frame = false;
}
void hdGetDoublev(unsigned what, double* values) {
  if (what == 0x2603) {
    values[0] = 3.3;
    return;
  }
  if (!in_frame) raise(kBadCall);
  if (world.unplugged) return raise(kCommunication);
  const palpate::Vec3 v = what == 0x2050 ? world.position() : world.velocity();
  for (std::size_t i = 0; i < 3; ++i) values[i] = 1e3 * v[i];
}
void hdGetIntegerv(unsigned, int* values) {
  if (!world.unplugged) values[0] = world.buttons;
}
void hdSetDoublev(unsigned what, const double* values) {
  if (!in_frame || what != 0x2700) return raise(kBadCall);
  if (world.unplugged) return raise(kCommunication);
  if (world.saturated) raise(kExceeded);
  world.send_force(world.forces_enabled ? palpate::Vec3{values[0], values[1], values[2]}
                                        : palpate::Vec3{});
}
void hdEnable(unsigned what) {
  if (what == 0x4000) world.forces_enabled = true;
}
void hdDisable(unsigned what) {
  if (what != 0x4000) return;
  world.forces_enabled = false;
  world.force = {};
}
void hdStartScheduler() {
  running = true;
  servo = std::thread(serve);
}
void hdStopScheduler() {
  running = false;
  if (servo.joinable()) servo.join();
}
unsigned long hdScheduleAsynchronous(unsigned (*function)(void*), void* data, unsigned short) {
  callback = function;
  user = data;
  return 1;
}
void hdUnschedule(unsigned long) {
  callback = nullptr;
}
HDErrorInfo hdGetError() {
  const std::scoped_lock lock(error_mutex);
  if (const unsigned queued = world.queued_error.exchange(0)) return {queued, 0, 7};
  if (errors.empty()) return {0, 0, 0};
  const unsigned code = errors.front();
  errors.pop_front();
  return {code, 0, 7};
}

}  // extern "C"
