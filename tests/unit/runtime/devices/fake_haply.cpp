// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/unit/runtime/devices/fake_haply.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "runtime/devices/websocket.hpp"

namespace palpate::test {
namespace {

bool read_exactly(int socket, char* to, std::size_t count, const std::atomic<bool>& stop) {
  while (count > 0) {
    pollfd wanted{socket, POLLIN, 0};
    if (stop) return false;
    if (poll(&wanted, 1, 5) <= 0) continue;
    const ssize_t n = recv(socket, to, count, 0);
    if (n <= 0) return false;
    to += n;
    count -= static_cast<std::size_t>(n);
  }
  return true;
}

void send_frame(int socket, unsigned first, const std::string& payload) {
  std::string frame(1, static_cast<char>(first));
  if (payload.size() < 126) {
    frame += static_cast<char>(payload.size());
  } else {
    frame += static_cast<char>(126);
    frame += static_cast<char>(payload.size() >> 8);
    frame += static_cast<char>(payload.size() & 255);
  }
  frame += payload;
  send(socket, frame.data(), frame.size(), MSG_NOSIGNAL);
}

nlohmann::json vector_of(const Vec3& v) {
  return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}};
}

}  // namespace

FakeHaplyService::FakeHaplyService(FakeWorld& world) : world_(world) {
  listener_ = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener_, generic, size) != 0 || listen(listener_, 4) != 0 ||
      getsockname(listener_, generic, &size) != 0) {
    throw std::runtime_error("fake Haply service: no port");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

FakeHaplyService::~FakeHaplyService() {
  stop_ = true;
  thread_.join();
  close(listener_);
}

void FakeHaplyService::serve() {
  while (!stop_) {
    pollfd wanted{listener_, POLLIN, 0};
    if (poll(&wanted, 1, 5) <= 0) continue;
    const int connection = accept(listener_, nullptr, nullptr);
    if (connection < 0) continue;
    const int yes = 1;
    setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    talk(connection);
    close(connection);
    ++world_.closed;
  }
}

void FakeHaplyService::talk(int connection) {
  std::string request;
  char c = 0;
  while (request.find("\r\n\r\n") == std::string::npos) {
    if (!read_exactly(connection, &c, 1, stop_)) return;
    request += c;
  }
  const std::string field = "Sec-WebSocket-Key: ";
  const std::size_t at = request.find(field) + field.size();
  const std::string key = request.substr(at, request.find("\r\n", at) - at);
  const std::string answered =
      "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Accept: " +
      runtime::websocket_accept(key) + "\r\n\r\n";
  send(connection, answered.data(), answered.size(), MSG_NOSIGNAL);
  ++world_.opened;
  send_frame(connection, 0x81, state(world_.present));
  while (!stop_ && !hang_up_) {
    char head[2];
    pollfd wanted{connection, POLLIN, 0};
    if (poll(&wanted, 1, 5) <= 0) continue;
    if (!read_exactly(connection, head, 2, stop_)) return;
    std::size_t length = head[1] & 0x7F;
    if (length == 126) {
      unsigned char more[2];
      if (!read_exactly(connection, reinterpret_cast<char*>(more), 2, stop_)) return;
      length = more[0] * 256U + more[1];
    }
    std::vector<char> rest(4 + length);
    if (!read_exactly(connection, rest.data(), rest.size(), stop_)) return;
    std::string message;
    for (std::size_t i = 0; i < length; ++i) {
      message += static_cast<char>(rest[4 + i] ^ rest[i % 4]);
    }
    const int opcode = head[0] & 0x0F;
    if (opcode == 8) return;
    if (opcode == 10) {
      ++pongs_;
      continue;
    }
    if (!answer(connection, message)) return;
  }
}

bool FakeHaplyService::answer(int connection, const std::string& message) {
  const auto parsed = nlohmann::json::parse(message);
  const auto& command = parsed.at("inverse3").at(0);
  if (command.at("device_id") != "049D") return false;
  const auto& force = command.at("commands").at("set_cursor_force").at("values");
  world_.send_force({force.at("x"), force.at("y"), force.at("z")});
  if (silent_) return true;
  world_.wait_for_device();
  while (world_.late && !stop_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (world_.forces % 10 == 3) send_frame(connection, 0x89, "are you there");
  const std::string whole = state(!world_.unplugged);
  const std::size_t half = whole.size() / 2;
  send_frame(connection, 0x01, whole.substr(0, half));
  send_frame(connection, 0x80, whole.substr(half));
  return true;
}

std::string FakeHaplyService::state(bool with_device) {
  nlohmann::json all{{"session_id", 1}, {"inverse3", nlohmann::json::array()}};
  if (with_device) {
    all["inverse3"].push_back(
        {{"device_id", "049D"},
         {"config", {{"handedness", "right"}, {"note", "a \"quoted\" }] word"}}},
         {"state",
          {{"cursor_position", vector_of(world_.position())},
           {"cursor_velocity", vector_of(world_.velocity())},
           {"current_cursor_force",
            vector_of((world_.saturated ? 0.25 : 1.0) * world_.last_force())}}}});
  }
  return all.dump();
}

}  // namespace palpate::test
