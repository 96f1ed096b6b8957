// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/watch/loopback_server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <functional>
#include <optional>
#include <unordered_set>
#include <utility>

#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using Text = std::shared_ptr<const std::string>;
using Request = http::request<http::empty_body>;

constexpr std::size_t kLongestRequest = 16384;  // bytes of its lines

Text shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

constexpr const char* kHeadings =
    "Cache-Control: no-store\r\n"
    "Connection: close\r\n"
    "Content-Security-Policy: frame-ancestors 'none'\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "X-Frame-Options: DENY\r\n";

std::string head(const char* status, const char* type, std::optional<std::size_t> length) {
  std::string text =
      std::string("HTTP/1.1 ") + status + "\r\nContent-Type: " + type + "\r\n" + kHeadings;
  if (length) text += "Content-Length: " + std::to_string(*length) + "\r\n";
  return text + "\r\n";
}

std::string whole(const char* status, const std::string& text) {
  return head(status, "text/plain; charset=utf-8", text.size()) + text;
}

/// By this host and from its own pages: another name would be that of a page which had its name
/// resolved to this machine.
bool is_ours(const Request& request, std::uint16_t port) {
  const std::string number = ":" + std::to_string(port);
  const auto field = [&](auto name) { return std::string(request[name]); };
  const std::string host = field(http::field::host), origin = field(http::field::origin);
  if (host != "127.0.0.1" + number && host != "localhost" + number) return false;
  if (!origin.empty() && origin != "http://" + host) return false;
  const std::string site = field("Sec-Fetch-Site");
  return site.empty() || site == "same-origin" || site == "none";
}

}  // namespace

struct LoopbackServer::State {
  explicit State(const std::string& text)
      : page(shared(head("200 OK", "text/html; charset=utf-8", text.size()) + text)) {}

  void accept();

  std::unordered_set<Client*> clients;  // outlives the context, whose end is that of its clients
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  std::uint16_t port = 0;
  Text page;
  Text last;  ///< event
};

/// A connection: one request, and what it is answered. It keeps itself alive by what it waits for.
class LoopbackServer::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(State& server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    parser_.header_limit(kLongestRequest);
    server_.clients.insert(this);
  }
  ~Client() { server_.clients.erase(this); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void start() {
    stream_.expires_after(kPatience);
    http::async_read_header(stream_, buffer_, parser_,
                            [self = shared_from_this()](beast::error_code failed, std::size_t) {
                              if (!failed) self->answer();
                            });
  }

  /// The newest event waits while another is being written; older ones are left out.
  void send(const Text& event) {
    if (!streams_) return;
    waiting_ = event;
    if (!writing_) write_waiting();
  }

 private:
  void answer() {
    const Request& request = parser_.get();
    const std::string target(request.target());
    if (!is_ours(request, server_.port)) {
      finish_with(
          shared(whole("403 Forbidden", "palpate watch serves pages of its own address only\n")));
    } else if (request.method() != http::verb::get) {
      finish_with(shared(whole("405 Method Not Allowed", "GET is all that there is\n")));
    } else if (target == "/") {
      finish_with(server_.page);
    } else if (target == "/steps") {
      stream();
    } else {
      finish_with(shared(whole("404 Not Found", "there are / and /steps\n")));
    }
  }

  void finish_with(const Text& text) {
    write(text, [self = shared_from_this()] { self->close(); });
  }

  void stream() {
    streams_ = true;
    watch_for_the_end();
    waiting_ = server_.last;
    write(shared(head("200 OK", "text/event-stream", {})),
          [self = shared_from_this()] { self->write_waiting(); });
  }

  /// A browser that leaves closes the connection, which only a read sees at once.
  void watch_for_the_end() {
    stream_.socket().async_read_some(
        asio::buffer(&ignored_, 1),
        [self = shared_from_this()](beast::error_code failed, std::size_t) {
          if (failed)
            self->close();
          else
            self->watch_for_the_end();
        });
  }

  void write_waiting() {
    if (!waiting_) return;
    write(std::exchange(waiting_, nullptr), [self = shared_from_this()] { self->write_waiting(); });
  }

  void write(const Text& text, std::function<void()> then) {
    writing_ = true;
    stream_.expires_after(kPatience);
    asio::async_write(stream_, asio::buffer(*text),
                      [self = shared_from_this(), text, then = std::move(then)](
                          beast::error_code failed, std::size_t) {
                        self->writing_ = false;
                        self->stream_.expires_never();
                        if (failed)
                          self->close();
                        else
                          then();
                      });
  }

  void close() {
    beast::error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
    stream_.socket().close(ignored);
    streams_ = false;
  }

  State& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> parser_;
  Text waiting_;
  char ignored_ = 0;
  bool streams_ = false, writing_ = false;
};

void LoopbackServer::State::accept() {
  acceptor.async_accept([this](beast::error_code failed, tcp::socket socket) {
    if (failed == asio::error::operation_aborted) return;
    if (!failed && clients.size() < kMostClients)
      std::make_shared<Client>(*this, std::move(socket))->start();
    accept();
  });
}

LoopbackServer::LoopbackServer(std::uint16_t port, const std::string& page)
    : state_(std::make_unique<State>(page)) {
  try {
    const tcp::endpoint here(asio::ip::address_v4::loopback(), port);
    state_->acceptor.open(here.protocol());
    state_->acceptor.set_option(tcp::acceptor::reuse_address(true));
    state_->acceptor.bind(here);
    state_->acceptor.listen();
    state_->port = state_->acceptor.local_endpoint().port();
  } catch (const boost::system::system_error& error) {
    refuse("watch",
           "port " + std::to_string(port) +
               " of 127.0.0.1 cannot be served: " + error.code().message(),
           "choose another with --port, or any that is free with --port 0");
  }
  state_->accept();
}

LoopbackServer::~LoopbackServer() = default;

std::uint16_t LoopbackServer::port() const {
  return state_->port;
}

std::size_t LoopbackServer::clients() const {
  return state_->clients.size();
}

void LoopbackServer::publish(const std::string& line) {
  state_->last = shared("data: " + line + "\n\n");
  // Sending never ends a client within the call: the set stays as it is.
  for (Client* client : state_->clients) client->send(state_->last);
}

void LoopbackServer::run_for(std::chrono::milliseconds time) {
  state_->context.restart();
  state_->context.run_for(time);
}

}  // namespace palpate::app
