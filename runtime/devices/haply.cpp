// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/haply.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "format/error.hpp"
#include "runtime/devices/json_view.hpp"

namespace palpate::runtime {
namespace {

constexpr int kInventoryTimeout = 2000;  // ms

bool take_vector(const JsonView& value, Vec3& v) noexcept {
  Vec3 taken{};
  const bool whole =
      value["x"].number(taken[0]) && value["y"].number(taken[1]) && value["z"].number(taken[2]);
  if (whole) v = taken;
  return whole;
}

}  // namespace

HaplyDevice::HaplyDevice(HaplySettings settings) : settings_(std::move(settings)) {}

HaplyDevice::~HaplyDevice() {
  close();
}

void HaplyDevice::open() {
  socket_.connect("Haply Inverse Service", settings_.host, settings_.port);
  find_device();
  halted_ = saturated_ = false;
  sent_ = sent_before_ = {};
  open_ = true;
  awaited_ = send_force({}) ? 1 : 0;
}

void HaplyDevice::find_device() {
  std::string_view inventory;
  if (socket_.receive(kInventoryTimeout, inventory) != WebSocket::Result::Message) {
    throw Error(ErrorKind::Configuration, "Haply Inverse Service", "it sent no inventory",
                "check its version: 3.5 is supported");
  }
  const JsonView devices = JsonView(inventory)["inverse3"];
  for (std::size_t i = 0; devices[i]; ++i) {
    const std::string id(devices[i]["device_id"].string());
    if (id.empty() || (!settings_.device_id.empty() && settings_.device_id != id)) continue;
    settings_.device_id = id;
    take_state(inventory);
    return;
  }
  socket_.close();
  const std::string which = settings_.device_id.empty() ? "no Inverse3" : settings_.device_id;
  throw Error(ErrorKind::Configuration, "Haply Inverse Service", which + " is not connected",
              "check power and cable, or leave the device out to take the first");
}

void HaplyDevice::close() noexcept {
  if (!open_) return;
  send_force({});
  socket_.close();
  open_ = false;
}

/// Reads the state of the device from a message; false when it is missing or incomplete.
bool HaplyDevice::take_state(std::string_view text) noexcept {
  const JsonView devices = JsonView(text)["inverse3"];
  for (std::size_t i = 0; devices[i]; ++i) {
    if (devices[i]["device_id"].string() != settings_.device_id) continue;
    const JsonView state = devices[i]["state"];
    Vec3 given{};
    saturated_ = take_vector(state["current_cursor_force"], given) && gives_less(given);
    return take_vector(state["cursor_position"], last_.position) &&
           take_vector(state["cursor_velocity"], last_.velocity);
  }
  return false;
}

bool HaplyDevice::gives_less(const Vec3& given) const noexcept {
  constexpr double kFraction = 0.9, kSmall = 0.05;  // N: comparable to friction and rounding
  const double asked = std::min(norm(sent_), norm(sent_before_));
  return norm(given) < kFraction * asked - kSmall;
}

DeviceStatus HaplyDevice::read(DeviceReading& reading) noexcept {
  if (!open_) return DeviceStatus::Lost;
  DeviceStatus status = DeviceStatus::Late;
  do {  // the newest of the states that have come
    std::string_view text;
    const int timeout = status == DeviceStatus::Late ? settings_.timeout_ms : 0;
    const WebSocket::Result result = socket_.receive(timeout, text);
    if (result == WebSocket::Result::Nothing) break;
    if (result == WebSocket::Result::Closed || !take_state(text)) {  // or unplugged: not listed
      status = DeviceStatus::Lost;
      break;
    }
    status = DeviceStatus::Good;
    awaited_ = std::max(awaited_ - 1, 0);
  } while (awaited_ > 0);
  reading = last_;
  return status;
}

bool HaplyDevice::send_force(const Vec3& force) noexcept {
  char text[512];
  std::size_t used = 0;
  const auto add = [&](std::string_view part) {
    const std::size_t count = std::min(part.size(), sizeof text - used);
    std::copy_n(part.data(), count, text + used);
    used += count;
  };
  const auto add_number = [&](double value) {  // not printf, whose decimal point is the locale's
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    add({digits, static_cast<std::size_t>(end - digits)});
  };
  add("{\"inverse3\":[{\"device_id\":\"");
  add(settings_.device_id);
  add("\",\"commands\":{\"set_cursor_force\":{\"values\":{\"x\":");
  add_number(force[0]);
  add(",\"y\":");
  add_number(force[1]);
  add(",\"z\":");
  add_number(force[2]);
  add("}}}}]}");
  return used < sizeof text && socket_.send({text, used});
}

DeviceStatus HaplyDevice::command(const Vec3& force) noexcept {
  if (!open_) return DeviceStatus::Lost;
  const Vec3 given = halted_ ? Vec3{} : force;
  if (awaited_ > 0 && !(norm(given) < norm(sent_))) return DeviceStatus::Late;
  sent_before_ = std::exchange(sent_, given);
  if (!send_force(sent_)) return DeviceStatus::Lost;
  ++awaited_;
  return saturated_ ? DeviceStatus::Saturated : DeviceStatus::Good;
}

void HaplyDevice::halt() noexcept {
  halted_ = true;
  if (open_) send_force({});
}

}  // namespace palpate::runtime
