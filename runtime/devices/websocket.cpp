// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/websocket.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <random>

#include "format/base64.hpp"
#include "format/error.hpp"
#include "runtime/realtime.hpp"

namespace palpate::runtime {
namespace {

constexpr unsigned kContinuation = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10;
constexpr std::size_t kMostSent = 1000;  // bytes of a message out
constexpr int kHandshakeTimeout = 2000;  // ms

/// SHA-1 [FIPS 180-4, 6.1], as the handshake requires; it protects no secret.
std::string sha1(std::string text) {
  std::array<std::uint32_t, 5> h{0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476, 0xC3D2E1F0};
  const std::uint64_t bits = 8 * text.size();
  text.push_back('\x80');
  while (text.size() % 64 != 56) text.push_back('\0');
  for (int shift = 56; shift >= 0; shift -= 8) text.push_back(static_cast<char>(bits >> shift));
  for (std::size_t block = 0; block < text.size(); block += 64) {
    std::array<std::uint32_t, 80> w{};
    for (std::size_t t = 0; t < 64; ++t) {
      w[t / 4] = w[t / 4] << 8 | static_cast<std::uint8_t>(text[block + t]);
    }
    for (std::size_t t = 16; t < 80; ++t) {
      w[t] = std::rotl(w[t - 3] ^ w[t - 8] ^ w[t - 14] ^ w[t - 16], 1);
    }
    auto [a, b, c, d, e] = h;
    for (std::size_t t = 0; t < 80; ++t) {
      const std::uint32_t f = t < 20   ? (b & c) | (~b & d)
                              : t < 40 ? b ^ c ^ d
                              : t < 60 ? (b & c) | (b & d) | (c & d)
                                       : b ^ c ^ d;
      constexpr std::array<std::uint32_t, 4> k{0x5A827999, 0x6ED9EBA1, 0x8F1BBCDC, 0xCA62C1D6};
      const std::uint32_t next = std::rotl(a, 5) + f + e + k[t / 20] + w[t];
      e = d, d = c, c = std::rotl(b, 30), b = a, a = next;
    }
    h = {h[0] + a, h[1] + b, h[2] + c, h[3] + d, h[4] + e};
  }
  std::string digest(20, '\0');
  for (std::size_t i = 0; i < digest.size(); ++i) {
    digest[i] = static_cast<char>(h[i / 4] >> (24 - 8 * (i % 4)));
  }
  return digest;
}

std::string random_key() {
  std::random_device random;
  std::string bytes(16, '\0');
  for (char& b : bytes) b = static_cast<char>(random());
  return base64(bytes);
}

[[noreturn]] void fail(const std::string& what, const std::string& problem) {
  throw Error(ErrorKind::Configuration, what, problem,
              "check that the service runs on this machine and its port");
}

int open_socket(const std::string& host, const std::string& port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return -1;
  int opened = -1;
  for (addrinfo* a = found; a != nullptr && opened < 0; a = a->ai_next) {
    opened = socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    if (opened >= 0 && connect(opened, a->ai_addr, a->ai_addrlen) != 0) {
      ::close(opened);
      opened = -1;
    }
  }
  freeaddrinfo(found);
  return opened;
}

}  // namespace

std::string websocket_accept(const std::string& key) {
  return base64(sha1(key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"));
}

WebSocket::~WebSocket() {
  close();
}

void WebSocket::connect(const std::string& what, const std::string& host, std::uint16_t port) {
  close();
  const std::string address = host + ":" + std::to_string(port);
  socket_ = open_socket(host, std::to_string(port));
  if (socket_ < 0) fail(what, "no answer from " + address);
  const int yes = 1;
  setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  bytes_.resize(kMostBytes);
  message_.resize(kMostBytes);
  used_ = assembled_ = 0;
  closed_ = false;
  shake_hands(what, address);
}

void WebSocket::shake_hands(const std::string& what, const std::string& address) {
  const std::string key = random_key();
  const std::string request = "GET / HTTP/1.1\r\nHost: " + address +
                              "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                              "Sec-WebSocket-Key: " +
                              key + "\r\nSec-WebSocket-Version: 13\r\n\r\n";
  ::send(socket_, request.data(), request.size(), MSG_NOSIGNAL);
  std::size_t end = std::string_view::npos;
  while (end == std::string_view::npos) {
    if (!fill(kHandshakeTimeout)) fail(what, address + " does not speak WebSocket");
    end = std::string_view(bytes_.data(), used_).find("\r\n\r\n");
  }
  const std::string answer(bytes_.data(), end);
  if (answer.rfind("HTTP/1.1 101", 0) != 0 ||
      answer.find(websocket_accept(key)) == std::string::npos) {
    fail(what, address + " refuses a WebSocket");
  }
  used_ -= end + 4;
  std::memmove(bytes_.data(), bytes_.data() + end + 4, used_);
}

void WebSocket::close() noexcept {
  if (socket_ < 0) return;
  send_frame(kClose, {});
  ::close(socket_);
  socket_ = -1;
}

/// Waits for bytes and appends them; false: none came, or the connection has ended.
bool WebSocket::fill(int timeout_ms) noexcept {
  pollfd wanted{socket_, POLLIN, 0};
  if (used_ == bytes_.size()) closed_ = true;  // a message longer than the buffer
  if (closed_ || poll(&wanted, 1, timeout_ms) <= 0) return false;
  const ssize_t count = recv(socket_, bytes_.data() + used_, bytes_.size() - used_, 0);
  if (count <= 0) {
    closed_ = count == 0 || (errno != EAGAIN && errno != EINTR);
    return false;
  }
  used_ += static_cast<std::size_t>(count);
  return true;
}

WebSocket::Result WebSocket::receive(int timeout_ms, std::string_view& message) noexcept {
  if (socket_ < 0) return Result::Closed;
  const std::int64_t deadline = monotonic_ns() + std::int64_t{1'000'000} * timeout_ms;
  while (true) {
    bool complete = false;
    while (!closed_ && take_frame(message, complete)) {
      if (complete) return Result::Message;
    }
    if (closed_) return Result::Closed;
    const std::int64_t left = (deadline - monotonic_ns()) / 1'000'000;
    if (!fill(static_cast<int>(std::max<std::int64_t>(left, 0)))) {
      return closed_ ? Result::Closed : Result::Nothing;
    }
  }
}

/// Removes one frame from the bytes; false when it is not complete.
bool WebSocket::take_frame(std::string_view& message, bool& complete) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes_[i]); };
  if (used_ < 2) return false;
  const bool last = (byte(0) & 0x80) != 0;
  const unsigned opcode = byte(0) & 0x0FU;
  std::size_t length = byte(1) & 0x7FU;
  std::size_t head = 2;
  if (length == 126) head = 4;
  if (length == 127) head = 10;
  if (used_ < head) return false;
  if (head > 2) length = 0;
  for (std::size_t i = 2; i < head; ++i) length = length << 8 | byte(i);
  if ((byte(1) & 0x80) != 0 || length > kMostBytes - head) {  // masked by a server, or too long
    closed_ = true;
    return false;
  }
  if (used_ < head + length) return false;
  const char* payload = bytes_.data() + head;
  if (opcode == kPing) {
    send_frame(kPong, {payload, length});
  } else if (opcode == kClose) {
    closed_ = true;
  } else if (opcode == kText || opcode == kBinary || opcode == kContinuation) {
    if (opcode != kContinuation) assembled_ = 0;
    if (assembled_ + length > message_.size()) {
      closed_ = true;
      return false;
    }
    std::memcpy(message_.data() + assembled_, payload, length);
    assembled_ += length;
    complete = last;
    message = {message_.data(), assembled_};
  }
  used_ -= head + length;
  std::memmove(bytes_.data(), bytes_.data() + head + length, used_);
  return true;
}

bool WebSocket::send(std::string_view message) noexcept {
  return send_frame(kText, message);
}

/// A client must mask what it sends [RFC 6455, 5.3]. The mask protects proxies from crafted
/// content; a fixed mask is enough for numbers to this machine.
bool WebSocket::send_frame(unsigned opcode, std::string_view payload) noexcept {
  if (socket_ < 0 || payload.size() > kMostSent) return false;
  constexpr std::array<std::uint8_t, 4> mask{0x5A, 0xC3, 0x17, 0x9E};
  std::array<std::uint8_t, kMostSent + 8> frame{};
  std::size_t n = 0;
  frame[n++] = static_cast<std::uint8_t>(0x80U | opcode);
  if (payload.size() < 126) {
    frame[n++] = static_cast<std::uint8_t>(0x80U | payload.size());
  } else {
    frame[n++] = 0x80U | 126U;
    frame[n++] = static_cast<std::uint8_t>(payload.size() >> 8);
    frame[n++] = static_cast<std::uint8_t>(payload.size());
  }
  for (const std::uint8_t m : mask) frame[n++] = m;
  for (std::size_t i = 0; i < payload.size(); ++i) {
    frame[n++] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(payload[i]) ^ mask[i % 4]);
  }
  const ssize_t sent = ::send(socket_, frame.data(), n, MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent == static_cast<ssize_t>(n);
}

}  // namespace palpate::runtime
