// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/force_dimension.hpp"

#include <utility>

#include "format/error.hpp"
#include "runtime/devices/dynamic_library.hpp"

namespace palpate::runtime {
namespace {

constexpr int kTimeguard = 1;                  // success: no new sample since the last call
constexpr int kSaturated = 2;                  // success: the motors give less
constexpr unsigned char kWatchdogTicks = 160;  // of 125 us: 20 ms
constexpr const char* kRemedy =
    "install the Force Dimension SDK and give its library with --driver PATH";

std::string model_of(int type) {
  switch (type) {
    case 33:
      return "Force Dimension omega.3";
    case 63:
      return "Force Dimension delta.3";
    case 60:
      return "Novint Falcon";
    case 104:
      return "Force Dimension sigma.7";
    case 108:
      return "Force Dimension lambda.7";
    default:
      return "Force Dimension, system type " + std::to_string(type);
  }
}

}  // namespace

/// The documented C functions; the device is always named, as C has no default arguments.
struct ForceDimensionDevice::Driver {
  explicit Driver(const std::string& path)
      : library(path.empty() ? std::vector<std::string>{"libdhd.so.3", "libdhd.so"}
                             : std::vector<std::string>{path},
                "Force Dimension", kRemedy) {
    library.bind(open, "dhdOpen");
    library.bind(open_id, "dhdOpenID");
    library.bind(close, "dhdClose");
    library.bind(stop, "dhdStop");
    library.bind(system_type, "dhdGetSystemType");
    library.bind(get_position, "dhdGetPosition");
    library.bind(get_velocity, "dhdGetLinearVelocity");
    library.bind(set_force, "dhdSetForce");
    library.bind(enable_force, "dhdEnableForce");
    library.bind(button_mask, "dhdGetButtonMask");
    library.bind(expert_mode, "dhdEnableExpertMode");
    library.bind(set_watchdog, "dhdSetWatchdog");
    library.bind(last_error, "dhdErrorGetLast");
    library.bind(error_text, "dhdErrorGetStr");
  }

  DynamicLibrary library;
  int (*open)(void);
  int (*open_id)(char);
  int (*close)(char);
  int (*stop)(char);
  int (*system_type)(char);
  int (*get_position)(double*, double*, double*, char);
  int (*get_velocity)(double*, double*, double*, char);
  int (*set_force)(double, double, double, char);
  int (*enable_force)(unsigned char, char);
  int (*button_mask)(char);
  int (*expert_mode)(void);
  int (*set_watchdog)(unsigned char, char);
  int (*last_error)(void);
  const char* (*error_text)(int);
};

ForceDimensionDevice::ForceDimensionDevice(ForceDimensionSettings settings)
    : settings_(std::move(settings)) {}

ForceDimensionDevice::~ForceDimensionDevice() {
  close();
}

void ForceDimensionDevice::fail(const std::string& what) const {
  const char* text = driver_->error_text(driver_->last_error());
  throw Error(ErrorKind::Configuration, "Force Dimension",
              what + ": " + (text != nullptr ? text : "unknown error"),
              "check power, cable, the calibration of the device and its USB rights");
}

void ForceDimensionDevice::open() {
  driver_ = std::make_unique<Driver>(settings_.library);
  const int id =
      settings_.id < 0 ? driver_->open() : driver_->open_id(static_cast<char>(settings_.id));
  if (id < 0) fail("no device was opened");
  id_ = static_cast<char>(id);
  open_ = true;
  halted_ = forces_enabled_ = false;
  name_ = model_of(driver_->system_type(id_));
  // A device without a watchdog of its own refuses; the one of the loop remains.
  if (driver_->expert_mode() >= 0) driver_->set_watchdog(kWatchdogTicks, id_);
}

void ForceDimensionDevice::close() noexcept {
  if (!open_) return;
  driver_->set_force(0, 0, 0, id_);
  driver_->stop(id_);
  driver_->close(id_);
  open_ = false;
}

DeviceStatus ForceDimensionDevice::read(DeviceReading& reading) noexcept {
  if (!open_) return DeviceStatus::Lost;
  auto& x = reading.position;
  auto& v = reading.velocity;
  const int position = driver_->get_position(&x[0], &x[1], &x[2], id_);
  const int velocity = driver_->get_velocity(&v[0], &v[1], &v[2], id_);
  const int buttons = driver_->button_mask(id_);
  if (position < 0 || velocity < 0 || buttons < 0) return DeviceStatus::Lost;
  reading.buttons = static_cast<std::uint32_t>(buttons);
  return position == kTimeguard ? DeviceStatus::Late : DeviceStatus::Good;
}

DeviceStatus ForceDimensionDevice::command(const Vec3& force) noexcept {
  if (!open_) return DeviceStatus::Lost;
  const Vec3 given = halted_ ? Vec3{} : force;
  if (!forces_enabled_ && norm(given) > 0) {
    if (driver_->enable_force(1, id_) < 0) return DeviceStatus::Lost;
    forces_enabled_ = true;
  }
  const int result = driver_->set_force(given[0], given[1], given[2], id_);
  if (result < 0) return DeviceStatus::Lost;
  return result == kSaturated ? DeviceStatus::Saturated : DeviceStatus::Good;
}

void ForceDimensionDevice::halt() noexcept {
  halted_ = true;
  if (open_) driver_->stop(id_);
}

}  // namespace palpate::runtime
