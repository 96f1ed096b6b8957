// SPDX-License-Identifier: AGPL-3.0-or-later
// A Haply Inverse Service for tests: a WebSocket server on this machine with one Inverse3.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "tests/unit/runtime/devices/fake_world.hpp"

namespace palpate::test {

/// Sends the inventory, then one state for each message, as the service is documented to. `late`
/// withholds the answers until it is cleared, fall_silent() for ever; `unplugged` leaves the device
/// out of them; hang_up() ends the connection. A ping comes now and then, and states in two parts.
class FakeHaplyService {
 public:
  explicit FakeHaplyService(FakeWorld& world);
  ~FakeHaplyService();

  std::uint16_t port() const { return port_; }
  void hang_up() { hang_up_ = true; }
  /// From now on takes forces, and answers none.
  void fall_silent() { silent_ = true; }
  int pongs() const { return pongs_; }

 private:
  void serve();
  void talk(int connection);
  bool answer(int connection, const std::string& message);
  std::string state(bool with_device);

  FakeWorld& world_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> stop_{false}, hang_up_{false}, silent_{false};
  std::atomic<int> pongs_{0};
  std::thread thread_;
};

}  // namespace palpate::test
