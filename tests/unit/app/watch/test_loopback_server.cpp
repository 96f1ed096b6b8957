// SPDX-License-Identifier: AGPL-3.0-or-later
// The server of a running session: whom it answers, and that no client is waited for.
#include "app/watch/loopback_server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "format/error.hpp"

namespace palpate::app {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A client by its socket, which does not block.
class Socket {
 public:
  explicit Socket(std::uint16_t port) : descriptor_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in there{};
    there.sin_family = AF_INET;
    there.sin_port = htons(port);
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(descriptor_, reinterpret_cast<sockaddr*>(&there), sizeof there) != 0)
      throw std::runtime_error("cannot connect");
  }
  ~Socket() { close(descriptor_); }
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  void say(const std::string& text) const {
    EXPECT_EQ(send(descriptor_, text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  /// What has come.
  std::string heard() const {
    std::string text(1 << 20, '\0');
    const ssize_t size = recv(descriptor_, text.data(), text.size(), MSG_DONTWAIT);
    text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return text;
  }

 private:
  int descriptor_;
};

class LoopbackServerTest : public testing::Test {
 protected:
  std::string host() const { return "Host: 127.0.0.1:" + std::to_string(server_.port()) + "\r\n"; }
  std::string get(const std::string& target) const {
    return "GET " + target + " HTTP/1.1\r\n" + host();
  }
  void serve() { server_.run_for(20ms); }
  /// The answer to a request.
  std::string answer(const std::string& request) {
    const Socket client(server_.port());
    serve();
    client.say(request + "\r\n");
    serve();
    return client.heard();
  }
  Socket listener() {
    Socket client(server_.port());
    client.say(get("/steps") + "\r\n");
    serve();
    return client;
  }

  LoopbackServer server_{0, "<p>the page</p>"};
};

TEST_F(LoopbackServerTest, GivesThePageToThisMachine) {
  const std::string page = answer(get("/"));
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(page, HasSubstr("Content-Length: 15\r\n"));
  EXPECT_THAT(page, testing::EndsWith("\r\n\r\n<p>the page</p>"));
  EXPECT_THAT(page, HasSubstr("X-Frame-Options: DENY\r\n"));
  EXPECT_THAT(page, Not(HasSubstr("Access-Control-Allow")));
  EXPECT_EQ(server_.clients(), 0U);
}

TEST_F(LoopbackServerTest, IsBoundToTheLoopbackAlone) {
  std::ostringstream port;
  port << std::hex << std::uppercase << server_.port();
  std::ifstream table("/proc/net/tcp");
  std::ostringstream text;
  text << table.rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("0100007F:" + port.str() + " 00000000:0000 0A"));
  EXPECT_THAT(text.str(), Not(HasSubstr("00000000:" + port.str() + " 00000000:0000 0A")));
}

TEST_F(LoopbackServerTest, RefusesOtherOriginsOtherNamesAndOtherRequests) {
  const std::string port = std::to_string(server_.port());
  const std::string refused = "HTTP/1.1 403 Forbidden\r\n";
  for (const char* target : {"/", "/steps"}) {
    EXPECT_THAT(answer(get(target) + "Origin: http://example.org\r\n"), StartsWith(refused));
    EXPECT_THAT(answer(get(target) + "Origin: null\r\n"), StartsWith(refused));
    EXPECT_THAT(answer(get(target) + "Origin: http://127.0.0.1:1\r\n"), StartsWith(refused));
    EXPECT_THAT(answer(get(target) + "Sec-Fetch-Site: cross-site\r\n"), StartsWith(refused));
    const std::string line = std::string("GET ") + target + " HTTP/1.1\r\n";
    EXPECT_THAT(answer(line + "Host: example.org:" + port + "\r\n"), StartsWith(refused));
    EXPECT_THAT(answer(line), StartsWith(refused));
    EXPECT_THAT(answer(get(target) + "Origin: http://127.0.0.1:" + port + "\r\n"),
                StartsWith("HTTP/1.1 200 OK\r\n"));
  }
  EXPECT_THAT(answer("GET / HTTP/1.1\r\nHost: localhost:" + port + "\r\n"),
              StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(answer("POST / HTTP/1.1\r\nContent-Length: 0\r\n" + host()),
              StartsWith("HTTP/1.1 405 "));
  EXPECT_THAT(answer(get("/etc/passwd")), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(answer("nonsense\r\n"), Not(HasSubstr("200")));
}

TEST_F(LoopbackServerTest, EachListenerGetsTheLastEventAtOnceAndThenEach) {
  server_.publish("old");
  server_.publish("first");
  const Socket early = listener();
  EXPECT_THAT(early.heard(), testing::EndsWith("\r\n\r\ndata: first\n\n"));
  const Socket late = listener();
  EXPECT_THAT(late.heard(), HasSubstr("data: first\n\n"));
  server_.publish("second");
  serve();
  EXPECT_EQ(early.heard(), "data: second\n\n");
  EXPECT_EQ(late.heard(), "data: second\n\n");
}

TEST_F(LoopbackServerTest, AClientThatNeverReadsCostsNothingAndDelaysNobody) {
  const Socket deaf = listener();
  const Socket other = listener();
  other.heard();
  const std::string ballast(100'000, 'x');
  for (int i = 0; i < 400; ++i) {  // 40 MB: far beyond what sockets hold
    server_.publish(ballast + std::to_string(i));
    server_.run_for(1ms);
    other.heard();
  }
  server_.publish("the last");
  std::string said;
  for (int i = 0; i < 50 && said.find("the last") == std::string::npos; ++i) {
    serve();
    said += other.heard();
  }
  EXPECT_THAT(said, HasSubstr("data: the last\n\n"));
  EXPECT_EQ(server_.clients(), 2U);  // the deaf one is dropped after kPatience
}

TEST_F(LoopbackServerTest, ClientsThatComeAndGoLeaveNothing) {
  for (int i = 0; i < 100; ++i) listener();
  for (int i = 0; i < 100; ++i) Socket(server_.port());
  for (int i = 0; i < 20 && server_.clients() > 0; ++i) serve();
  EXPECT_EQ(server_.clients(), 0U);
  EXPECT_THAT(answer(get("/")), StartsWith("HTTP/1.1 200 OK\r\n"));
}

TEST_F(LoopbackServerTest, HasRoomForSoManyClientsAndNoMore) {
  std::vector<Socket> clients;
  for (std::size_t i = 0; i < LoopbackServer::kMostClients + 5; ++i)
    clients.emplace_back(server_.port());
  serve();
  EXPECT_EQ(server_.clients(), LoopbackServer::kMostClients);
  clients.clear();
  for (int i = 0; i < 20 && server_.clients() > 0; ++i) serve();
  EXPECT_THAT(answer(get("/")), StartsWith("HTTP/1.1 200 OK\r\n"));
}

TEST_F(LoopbackServerTest, APortThatIsTakenIsSaid) {
  try {
    LoopbackServer second(server_.port(), "");
    FAIL() << "two servers on one port";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("--port"));
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(server_.port())));
  }
}

}  // namespace
}  // namespace palpate::app
