// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <optional>
#include <regex>
#include <utility>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

#include "address.h"
#include "link.h"

namespace doorforge::internal {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Socket = beast::websocket::stream<beast::tcp_stream>;

class WebSocketLink : public Link {
 public:
  WebSocketLink(ServerAddress address, double timeout_s)
      : address_(std::move(address)),
        timeout_(std::chrono::milliseconds(static_cast<long>(1000 * timeout_s))) {}

  std::string Open() override {
    if (socket_) return "";
    asio::ip::tcp::resolver resolver(context_);
    beast::error_code unknown;
    const auto places = resolver.resolve(address_.host, address_.port, unknown);
    if (unknown) throw Failed("the host is not known", ErrorCode::kMissing);
    socket_.emplace(context_);
    Wait("no server answers", [&](auto done) {
      beast::get_lowest_layer(*socket_).async_connect(
          places, [done](beast::error_code error, const auto&) { done(error); });
    });
    beast::get_lowest_layer(*socket_).socket().set_option(asio::ip::tcp::no_delay(true));
    socket_->read_message_max(std::size_t{1} << 28);
    Wait("what answers there is no WebSocket", [&](auto done) {
      socket_->async_handshake(address_.host + ":" + address_.port, address_.path, done);
    });
    socket_->binary(true);
    return Read();  // openpi's servers say first what they are
  }

  std::string Exchange(const std::string& message) override {
    Open();
    Wait("the server went away", [&](auto done) {
      socket_->async_write(asio::buffer(message),
                           [done](beast::error_code error, std::size_t) { done(error); });
    });
    return Read();
  }

  void Close() override { socket_.reset(); }

 private:
  Error Failed(const std::string& problem, ErrorCode code = ErrorCode::kIo) {
    Close();
    return {code, address_.text + ": " + problem};
  }

  std::string Read() {
    beast::flat_buffer buffer;
    Wait("the server went away", [&](auto done) {
      socket_->async_read(buffer, [done](beast::error_code error, std::size_t) { done(error); });
    });
    std::string message = beast::buffers_to_string(buffer.data());
    if (!socket_->got_text()) return message;
    // an answer in text is how openpi's servers say that they failed
    constexpr std::size_t kMostText = 500;
    if (message.size() > kMostText) message = "..." + message.substr(message.size() - kMostText);
    throw Failed("the server reports: " + message);
  }

  // Lets an operation run until it is done, the time is over, or the program is asked to stop.
  template <class Start>
  void Wait(const std::string& problem, Start&& start) {
    std::optional<beast::error_code> result;
    start([&result](beast::error_code error) { result = error; });
    context_.restart();
    const auto end = std::chrono::steady_clock::now() + timeout_;
    while (!result && std::chrono::steady_clock::now() < end && StopRequested() == 0)
      context_.run_one_for(std::chrono::milliseconds(50));
    if (!result) {
      // the operation refers to what goes away here
      beast::get_lowest_layer(*socket_).close();
      while (!result) context_.run_one();
      throw Failed(
          StopRequested() != 0
              ? "stopped"
              : "no answer within " +
                    std::to_string(std::chrono::duration<double>(timeout_).count()).substr(0, 5) +
                    " s (--policy-timeout)");
    }
    if (*result) throw Failed(problem + " (" + result->message() + ")", ErrorCode::kMissing);
  }

  ServerAddress address_;
  std::chrono::milliseconds timeout_;
  asio::io_context context_;
  std::optional<Socket> socket_;
};

}  // namespace

ServerAddress AddressOf(const std::string& word) {
  static const std::regex form(R"(ws://([A-Za-z0-9.-]+|\[[0-9a-fA-F:]+\]):(\d{1,5})(/\S*)?)");
  std::smatch found;
  if (!std::regex_match(word, found, form) || std::stoi(found[2]) > 65535)
    throw Error(ErrorCode::kInvalidArgument,
                "\"" + word + "\": expected the address of a server, such as ws://127.0.0.1:8000");
  std::string host = found[1];
  if (host.front() == '[') host = host.substr(1, host.size() - 2);
  return {word, host, found[2], found[3].length() > 0 ? std::string(found[3]) : "/"};
}

std::unique_ptr<Link> MakeWebSocketLink(const std::string& address, double timeout_s) {
  return std::make_unique<WebSocketLink>(AddressOf(address), timeout_s);
}

}  // namespace doorforge::internal
