// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "runtime/device.hpp"

namespace palpate::test {

/// A device that does what a test tells it: where it is, and what goes wrong at which step.
class ScriptedDevice : public runtime::Device {
 public:
  std::string name() const override { return "scripted"; }
  void open() override {}
  void close() noexcept override {}
  runtime::DeviceStatus read(runtime::DeviceReading& reading) noexcept override {
    const int step = reads++;
    if (before_read) before_read(step);
    reading = place ? place(step) : runtime::DeviceReading{};
    return status_of_read ? status_of_read(step) : runtime::DeviceStatus::Good;
  }
  runtime::DeviceStatus command(const Vec3& force) noexcept override {
    commanded.push_back(force);
    return status_of_command ? status_of_command(reads - 1) : runtime::DeviceStatus::Good;
  }
  void halt() noexcept override { halted = true; }

  std::function<void(int)> before_read;
  std::function<runtime::DeviceReading(int)> place;
  std::function<runtime::DeviceStatus(int)> status_of_read, status_of_command;
  int reads = 0;
  std::vector<Vec3> commanded;
  std::atomic<bool> halted{false};
};

}  // namespace palpate::test
