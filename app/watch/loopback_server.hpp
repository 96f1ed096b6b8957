// SPDX-License-Identifier: AGPL-3.0-or-later
// A page and a stream of events for browsers of this machine.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace palpate::app {

/// Serves on 127.0.0.1 alone: "/" is the page, "/steps" the events (text/event-stream). Requests
/// that come by another name of the host, or from the page of another origin, are refused. A client
/// that does not read misses events and is dropped in time; there are at most kMostClients. Works
/// in run_for alone; one thread.
class LoopbackServer {
 public:
  static constexpr std::size_t kMostClients = 32;
  static constexpr std::chrono::seconds kPatience{
      10};  ///< for a request, and for a client that takes nothing

  /// port 0: any that is free. @throws Error(Configuration) where it cannot be bound.
  LoopbackServer(std::uint16_t port, const std::string& page);
  ~LoopbackServer();
  LoopbackServer(const LoopbackServer&) = delete;
  LoopbackServer& operator=(const LoopbackServer&) = delete;

  std::uint16_t port() const;
  std::size_t clients() const;
  /// One line of text for each client of the stream that has taken the one before; also for clients
  /// that come later.
  void publish(const std::string& line);
  void run_for(std::chrono::milliseconds time);

 private:
  struct State;
  class Client;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::app
