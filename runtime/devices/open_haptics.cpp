// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/open_haptics.hpp"

#include <cstdio>
#include <utility>

#include "format/error.hpp"
#include "runtime/devices/dynamic_library.hpp"

namespace palpate::runtime {
namespace {

constexpr unsigned kInvalidHandle = 0xFFFFFFFF;
constexpr unsigned kButtons = 0x2000;
constexpr unsigned kPosition = 0x2050;      // mm
constexpr unsigned kVelocity = 0x2051;      // mm/s
constexpr unsigned kMaxForce = 0x2603;      // N
constexpr unsigned kCurrentForce = 0x2700;  // N
constexpr unsigned kForceOutput = 0x4000;
constexpr unsigned kFirstForceError = 0x0200, kLastForceError = 0x0204;
constexpr unsigned kFirstDeviceError = 0x0300, kLastDeviceError = 0x0304;
constexpr unsigned kDone = 0, kContinue = 1;
constexpr unsigned short kHighestPriority = 0xFFFF;
constexpr double kMillimetre = 1e-3;  // m
constexpr int kMostErrors = 16;       // queued errors looked at in one step

struct ErrorInfo {
  unsigned code;
  int internal;
  unsigned handle;
};

}  // namespace

struct OpenHapticsDevice::Driver {
  explicit Driver(const std::string& path)
      : library(path.empty() ? std::vector<std::string>{"libHD.so", "libHD.so.3.4"}
                             : std::vector<std::string>{path},
                "OpenHaptics",
                "install OpenHaptics and its device driver, and give libHD.so with --driver PATH") {
    library.bind(init_device, "hdInitDevice");
    library.bind(make_current, "hdMakeCurrentDevice");
    library.bind(disable_device, "hdDisableDevice");
    library.bind(begin_frame, "hdBeginFrame");
    library.bind(end_frame, "hdEndFrame");
    library.bind(get_doubles, "hdGetDoublev");
    library.bind(get_integers, "hdGetIntegerv");
    library.bind(set_doubles, "hdSetDoublev");
    library.bind(enable, "hdEnable");
    library.bind(disable, "hdDisable");
    library.bind(start_scheduler, "hdStartScheduler");
    library.bind(stop_scheduler, "hdStopScheduler");
    library.bind(schedule, "hdScheduleAsynchronous");
    library.bind(unschedule, "hdUnschedule");
    library.bind(get_error, "hdGetError");
  }

  DynamicLibrary library;
  unsigned (*init_device)(const char*);
  void (*make_current)(unsigned);
  void (*disable_device)(unsigned);
  void (*begin_frame)(unsigned);
  void (*end_frame)(unsigned);
  void (*get_doubles)(unsigned, double*);
  void (*get_integers)(unsigned, int*);
  void (*set_doubles)(unsigned, const double*);
  void (*enable)(unsigned);
  void (*disable)(unsigned);
  void (*start_scheduler)(void);
  void (*stop_scheduler)(void);
  unsigned long (*schedule)(unsigned (*)(void*), void*, unsigned short);
  void (*unschedule)(unsigned long);
  ErrorInfo (*get_error)(void);
};

OpenHapticsDevice::OpenHapticsDevice(OpenHapticsSettings settings)
    : settings_(std::move(settings)) {}

OpenHapticsDevice::~OpenHapticsDevice() {
  close();
}

void OpenHapticsDevice::fail(const std::string& what, unsigned code) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%04X", code);
  throw Error(ErrorKind::Configuration, "OpenHaptics", what + " (error " + text + ")",
              "check power, cable and licence, and that the vendor's setup knows the device");
}

void OpenHapticsDevice::open() {
  driver_ = std::make_unique<Driver>(settings_.library);
  drain_errors();  // of an earlier session
  handle_ = driver_->init_device(settings_.device.empty() ? nullptr : settings_.device.c_str());
  if (handle_ == kInvalidHandle) fail("no device was opened", driver_->get_error().code);
  driver_->make_current(handle_);
  driver_->enable(kForceOutput);
  driver_->get_doubles(kMaxForce, &peak_force_);
  open_ = true;
  halted_ = false;
  const unsigned code = driver_->get_error().code;
  if (code == 0) return;
  close();
  fail("the device does not answer", code);
}

void OpenHapticsDevice::close() noexcept {
  stop_calls();
  if (!open_) return;
  driver_->disable(kForceOutput);
  driver_->disable_device(handle_);
  open_ = false;
}

/// The driver queues its errors until they are read.
DeviceStatus OpenHapticsDevice::drain_errors() noexcept {
  DeviceStatus status = DeviceStatus::Good;
  for (int i = 0; i < kMostErrors; ++i) {
    const unsigned code = driver_->get_error().code;
    if (code == 0) break;
    const bool of_force = code >= kFirstForceError && code <= kLastForceError;
    const bool of_device = code >= kFirstDeviceError && code <= kLastDeviceError;
    if (of_device) return DeviceStatus::Lost;
    if (of_force) status = DeviceStatus::Saturated;
  }
  return status;
}

DeviceStatus OpenHapticsDevice::read(DeviceReading& reading) noexcept {
  if (!open_) return DeviceStatus::Lost;
  driver_->begin_frame(handle_);
  in_frame_ = true;
  driver_->get_doubles(kPosition, reading.position.data());
  driver_->get_doubles(kVelocity, reading.velocity.data());
  int buttons = 0;
  driver_->get_integers(kButtons, &buttons);
  reading.buttons = static_cast<std::uint32_t>(buttons);
  reading.position = kMillimetre * reading.position;
  reading.velocity = kMillimetre * reading.velocity;
  const DeviceStatus status = drain_errors();
  if (status == DeviceStatus::Lost) {
    driver_->end_frame(handle_);
    in_frame_ = false;
  }
  return status;
}

DeviceStatus OpenHapticsDevice::command(const Vec3& force) noexcept {
  if (!open_) return DeviceStatus::Lost;
  const Vec3 given = halted_ ? Vec3{} : force;
  if (!in_frame_) driver_->begin_frame(handle_);  // the last command, after the loop
  driver_->set_doubles(kCurrentForce, given.data());
  driver_->end_frame(handle_);
  in_frame_ = false;
  return drain_errors();
}

void OpenHapticsDevice::halt() noexcept {
  halted_ = true;
  if (open_) driver_->disable(kForceOutput);
}

unsigned OpenHapticsDevice::servo_tick(void* self) {
  return static_cast<OpenHapticsDevice*>(self)->step_() ? kContinue : kDone;
}

void OpenHapticsDevice::start_calls(std::function<bool()> step) {
  step_ = std::move(step);
  schedule_ = driver_->schedule(&OpenHapticsDevice::servo_tick, this, kHighestPriority);
  driver_->start_scheduler();
  calling_ = true;
  const unsigned code = driver_->get_error().code;
  if (code == 0) return;
  stop_calls();
  fail("the scheduler did not start", code);
}

void OpenHapticsDevice::stop_calls() noexcept {
  if (!calling_) return;
  driver_->stop_scheduler();
  driver_->unschedule(schedule_);
  calling_ = false;
}

}  // namespace palpate::runtime
