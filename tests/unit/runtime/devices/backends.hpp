// SPDX-License-Identifier: AGPL-3.0-or-later
// The bindings under test, each with its fake.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/device.hpp"
#include "tests/unit/runtime/devices/fake_world.hpp"

namespace palpate::test {

struct Backend {
  std::string name;
  FakeWorld* world = nullptr;
  std::function<std::unique_ptr<runtime::Device>()> make;
  /// The same binding where its library or service is not there.
  std::function<std::unique_ptr<runtime::Device>()> make_without_driver;
  std::string driver_word;        ///< what the message about that must name
  double position_error = 1e-12;  ///< m
  double force_error = 1e-12;     ///< N
  bool gives_velocity = true;     ///< else it is filtered from positions
  bool reports_late = false;
  bool saturates_by_itself = true;  ///< else beyond 10 N along an axis
};

/// Force Dimension, OpenHaptics, Haply, and a lab-built device on a Comedi board.
std::vector<Backend>& backends();

}  // namespace palpate::test
