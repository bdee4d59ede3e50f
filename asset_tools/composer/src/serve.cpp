// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/composer/serve.h"

#include <chrono>
#include <memory>
#include <thread>

#include <httplib.h>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"

#include "dropped_files.h"

namespace doorforge {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 10;  // of a request
constexpr auto kLook = std::chrono::milliseconds(50);          // how often a stop is looked for

// Uncompressed: nothing travels further than this machine, and httplib would compress a page for as
// long as it takes to make it as small as can be, before its first byte is sent.
void Give(httplib::Response& response, std::string content, const char* type) {
  const auto kept = std::make_shared<const std::string>(std::move(content));
  response.set_content_provider(
      kept->size(), type, [kept](std::size_t from, std::size_t bytes, httplib::DataSink& sink) {
        return sink.write(kept->data() + from, bytes);
      });
}

void Refuse(httplib::Response& response, int status, const std::string& message) {
  response.status = status;
  Give(response, JsonText({{"error", message}}), "application/json");
}

int StatusOf(const Error& error) {
  if (error.code() == ErrorCode::kMissing) return 404;
  return error.code() == ErrorCode::kIo ? 500 : 400;
}

/// Only pages that this server gave, on this machine, may ask.
class Doorkeeper {
 public:
  explicit Doorkeeper(int port)
      : hosts_{"127.0.0.1:" + std::to_string(port), "localhost:" + std::to_string(port)} {}

  bool LetsIn(const httplib::Request& request) const {
    const std::string host = request.get_header_value("Host");
    if (host != hosts_[0] && host != hosts_[1]) return false;
    const std::string site = request.get_header_value("Sec-Fetch-Site");
    if (!site.empty() && site != "same-origin" && site != "none") return false;
    return !request.has_header("Origin") || request.get_header_value("Origin") == "http://" + host;
  }

 private:
  std::array<std::string, 2> hosts_;
};

// Answers with what `make` gives, or with why it cannot.
template <class Make>
void Answer(httplib::Response& response, const char* type, Make&& make) {
  try {
    Give(response, make(), type);
  } catch (const Error& error) {
    Refuse(response, StatusOf(error), error.what());
  } catch (const std::exception& error) {
    Refuse(response, 500, error.what());
  }
}

void AddAnswers(httplib::Server& server, Composer& composer) {
  server.Get("/", [&](const httplib::Request&, httplib::Response& response) {
    Answer(response, "text/html; charset=utf-8", [&] { return composer.Page(); });
  });
  server.Get(R"(/thumbnail/([A-Za-z0-9_.\-]+))", [&](const httplib::Request& request,
                                                     httplib::Response& response) {
    Answer(response, "image/jpeg", [&] { return composer.Thumbnail(request.matches[1]); });
  });
  server.Post("/file", [&](const httplib::Request& request, httplib::Response& response) {
    Answer(response, "application/octet-stream",
           [&] { return composer.Keep(request.get_param_value("name"), request.body); });
  });
  server.Post("/compose", [&](const httplib::Request& request, httplib::Response& response) {
    Answer(response, "application/octet-stream", [&] { return composer.Compose(request.body); });
  });
  server.Post("/open", [&](const httplib::Request& request, httplib::Response& response) {
    Answer(response, "application/octet-stream", [&] { return composer.Open(request.body); });
  });
  server.Post("/download", [&](const httplib::Request& request, httplib::Response& response) {
    Answer(response, "application/zip",
           [&] { return composer.Download(request.body, request.get_param_value("format")); });
  });
}

struct Refusal {
  int status = 0;  // 0: none
  std::string message;
};

// What a request brings along must say how long it is, and is taken as it is: a compressed body
// would be unpacked without limit.
Refusal RefusalOfBody(const httplib::Request& request) {
  const bool is_file = request.path == "/file";
  const std::string type = is_file ? "application/octet-stream" : "application/json";
  if (request.get_header_value("Content-Type") != type) return {415, "a request is " + type};
  if (request.has_header("Content-Encoding") || request.has_header("Transfer-Encoding"))
    return {415, "a request is neither compressed nor in chunks"};
  if (!request.has_header("Content-Length")) return {411, "a request says its length"};
  const auto bytes = request.get_header_value<std::uint64_t>("Content-Length");
  if (is_file && bytes > internal::kMostFileBytes)
    return {413, request.get_param_value("name") + ": has " + std::to_string(bytes >> 20) +
                     " MiB, a dropped file may have 64; doorforge compose takes 512"};
  if (!is_file && bytes > kMostBytes) return {413, "a request has at most 64 KiB"};
  return {};
}

void Guard(httplib::Server& server, int port) {
  server.set_payload_max_length(internal::kMostFileBytes);
  server.set_keep_alive_max_count(1);  // what is refused is not read, so that nothing can follow it
  server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                              {"Cache-Control", "no-store"},
                              {"Cross-Origin-Resource-Policy", "same-origin"}});
  server.set_pre_routing_handler(
      [keeper = Doorkeeper(port)](const httplib::Request& request, httplib::Response& response) {
        Refusal refusal;
        if (!keeper.LetsIn(request))
          refusal = {403, "only pages of this server on this machine may ask"};
        else if (request.method == "POST")
          refusal = RefusalOfBody(request);
        else if (request.method != "GET" && request.method != "HEAD")
          refusal = {405, "only GET and POST are answered"};
        if (refusal.status == 0) return httplib::Server::HandlerResponse::Unhandled;
        Refuse(response, refusal.status, refusal.message);
        return httplib::Server::HandlerResponse::Handled;
      });
}

}  // namespace

void ServeComposer(Composer& composer, int port,
                   const std::function<void(const std::string&)>& ready) {
  httplib::Server server;
  const int bound = port == 0 ? server.bind_to_any_port("127.0.0.1")
                              : (server.bind_to_port("127.0.0.1", port) ? port : -1);
  if (bound < 0)
    throw Error(ErrorCode::kIo, "port " + std::to_string(port) +
                                    " is taken; give another one with --port, or 0 for any");
  Guard(server, bound);
  AddAnswers(server, composer);
  std::thread listener([&] { server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::sleep_for(kLook);
  ready("http://127.0.0.1:" + std::to_string(bound) + "/");
  while (StopRequested() == 0) std::this_thread::sleep_for(kLook);
  server.stop();
  listener.join();
}

}  // namespace doorforge
