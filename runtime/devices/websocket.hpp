// SPDX-License-Identifier: Apache-2.0
// A WebSocket client for short text messages to a service on this machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::runtime {

/// The Sec-WebSocket-Accept that belongs to a Sec-WebSocket-Key [RFC 6455, 4.2.2].
std::string websocket_accept(const std::string& key);

/// One connection [RFC 6455]: text messages out in one masked frame, messages in, whole or in
/// parts; pings are answered. Messages up to 64 kB. One thread, besides send(), which may also be
/// called from another: a frame leaves in one system call. Sending and receiving do not allocate.
class WebSocket {
 public:
  WebSocket() = default;
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  /// Connects and performs the handshake. @throws Error(Configuration) naming `what` and the
  /// address.
  void connect(const std::string& what, const std::string& host, std::uint16_t port);
  void close() noexcept;

  enum class Result : std::uint8_t { Message, Nothing, Closed };
  /// Waits up to timeout_ms for a message; the view is valid until the next call.
  Result receive(int timeout_ms, std::string_view& message) noexcept;
  bool send(std::string_view message) noexcept;  ///< at most 1000 bytes; false: closed

 private:
  static constexpr std::size_t kMostBytes = 65536;

  void shake_hands(const std::string& what, const std::string& address);
  bool fill(int timeout_ms) noexcept;
  bool take_frame(std::string_view& message, bool& complete) noexcept;
  bool send_frame(unsigned opcode, std::string_view payload) noexcept;

  int socket_ = -1;
  bool closed_ = false;
  std::vector<char> bytes_;    ///< received, not yet taken
  std::size_t used_ = 0;       ///< of bytes_
  std::vector<char> message_;  ///< parts so far
  std::size_t assembled_ = 0;  ///< of message_
};

}  // namespace palpate::runtime
