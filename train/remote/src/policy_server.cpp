// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/remote/policy_server.h"

#include <atomic>
#include <chrono>
#include <list>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

#include "message.h"

namespace doorforge {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

using internal::NumpyArray;
using internal::Value;

constexpr std::size_t kMostBytes = std::size_t{1} << 26;
constexpr int kMostConnections = 64;

LabelledCloud CloudOf(const NumpyArray& array, const std::string& name) {
  if (array.shape.size() != 2 || array.shape[1] != 3)
    throw Error(ErrorCode::kFormat, name + ": expected the shape (points, 3)");
  LabelledCloud cloud;
  for (const double number : array.Numbers(name)) cloud.xyz.push_back(static_cast<float>(number));
  cloud.label.assign(static_cast<std::size_t>(array.shape[0]),
                     static_cast<std::uint8_t>(PointLabel::kOther));
  return cloud;
}

const NumpyArray& ArrayIn(const Value& request, const std::string& name) {
  const Value* found = request.Find(name);
  const auto* array = found == nullptr ? nullptr : found->As<NumpyArray>();
  if (array == nullptr)
    throw Error(ErrorCode::kFormat,
                "the request has no array \"" + name +
                    "\"; expected are \"proprioception\" float32 (32,) and, for policies that "
                    "look, \"cloud\" float32 (points, 3), packed as msgpack_numpy does");
  return *array;
}

Observation ObservationOf(const Value& request, bool looks) {
  Observation observation;
  const NumpyArray& felt = ArrayIn(request, "proprioception");
  const std::vector<double> numbers = felt.Numbers("proprioception");
  if (numbers.size() != observation.proprioception.size())
    throw Error(ErrorCode::kFormat,
                "proprioception: " + std::to_string(numbers.size()) + " numbers, expected 32");
  for (std::size_t i = 0; i < numbers.size(); ++i)
    observation.proprioception[i] = static_cast<float>(numbers[i]);
  if (!looks) return observation;
  observation.cloud = CloudOf(ArrayIn(request, "cloud"), "cloud");
  return observation;
}

bool IsTrue(const Value* value) {
  const bool* flag = value == nullptr ? nullptr : value->As<bool>();
  return flag != nullptr && *flag;
}

// What was seen before the robot came, where a request has it.
std::optional<LabelledCloud> BeforeIn(const Value& request) {
  if (request.Find("before") == nullptr) return std::nullopt;
  return CloudOf(ArrayIn(request, "before"), "before");
}

std::string AnswerTo(const std::string& message, LonePolicy& policy) {
  const auto begin = std::chrono::steady_clock::now();
  const Value request = internal::Unpacked(message);
  if (IsTrue(request.Find("episode_start"))) policy.Begin(BeforeIn(request));
  const Observation observation = ObservationOf(request, policy.UsesPointCloud());
  const bool is_joined = IsTrue(request.Find("remembered"));
  const ActionNumbers action =
      ToNumbers(is_joined ? policy.ActOnJoined(observation) : policy.Act(observation));
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  Value::Map answer;
  answer["actions"] = {internal::ArrayOf(action.data(), {1, 9})};
  if (policy.Says()) answer["turned"] = {policy.Turned()};
  answer["server_timing"] = {Value::Map{{"infer_ms", {took.count()}}}};
  return internal::Packed({std::move(answer)});
}

std::string Greeting(const PolicyServerConfig& config, const LonePolicy& policy) {
  Value::List arrays = {{std::string("proprioception")}};
  if (policy.UsesPointCloud()) arrays.push_back({std::string("cloud")});
  return internal::Packed(
      {Value::Map{{"server", {"doorforge " + CodeVersion()}},
                  {"policy", {config.policy}},
                  {"stage", {config.stage}},
                  {"observation", {std::move(arrays)}},
                  {"remembered",
                   {Value::Map{{"finer", {std::int64_t{policy.remembered().resolution_scale}}},
                               {"within_m", {policy.remembered().crop_radius_m}}}}},
                  {"action_dim", {std::int64_t{9}}},
                  {"action_horizon", {std::int64_t{1}}}}});
}

/// One who has connected, on a thread of its own.
class Connection {
 public:
  Connection(std::unique_ptr<asio::io_context> context, asio::ip::tcp::socket socket)
      : context_(std::move(context)), socket_(beast::tcp_stream(std::move(socket))) {}

  void Serve(const PolicyServerConfig& config, LonePolicy& policy) {
    beast::get_lowest_layer(socket_).socket().set_option(asio::ip::tcp::no_delay(true));
    socket_.read_message_max(kMostBytes);
    if (!Done([&](auto done) { socket_.async_accept(done); })) return;
    policy.Reset();
    if (!Send(Greeting(config, policy), false)) return;
    while (true) {
      beast::flat_buffer buffer;
      const bool read = Done([&](auto done) {
        socket_.async_read(buffer, [done](beast::error_code error, std::size_t) { done(error); });
      });
      if (!read) return;
      std::string answer;
      bool failed = false;
      try {
        answer = AnswerTo(beast::buffers_to_string(buffer.data()), policy);
      } catch (const Error& error) {
        answer = error.what();
        failed = true;
      }
      if (!Send(answer, failed)) return;
    }
  }

 private:
  bool Send(const std::string& message, bool is_text) {
    socket_.text(is_text);
    return Done([&](auto done) {
      socket_.async_write(asio::buffer(message),
                          [done](beast::error_code error, std::size_t) { done(error); });
    });
  }

  // Whether an operation came to a good end before the program was asked to stop.
  template <class Start>
  bool Done(Start&& start) {
    std::optional<beast::error_code> result;
    start([&result](beast::error_code error) { result = error; });
    context_->restart();
    while (!result && StopRequested() == 0) context_->run_one_for(std::chrono::milliseconds(100));
    if (!result) {
      beast::get_lowest_layer(socket_).close();
      while (!result) context_->run_one();
      return false;
    }
    return !*result;
  }

  std::unique_ptr<asio::io_context> context_;
  beast::websocket::stream<beast::tcp_stream> socket_;
};

struct Served {
  std::thread thread;
  std::atomic<bool> over = false;
};

}  // namespace

void ServePolicy(const PolicyServerConfig& config,
                 const std::function<std::unique_ptr<LonePolicy>()>& make,
                 const std::function<void(int)>& ready) {
  asio::io_context context;
  beast::error_code error;
  const auto host = asio::ip::make_address(config.host, error);
  Require(!error, ErrorCode::kInvalidArgument,
          "--host " + config.host + ": expected an address, such as 127.0.0.1");
  asio::ip::tcp::acceptor acceptor(context);
  const asio::ip::tcp::endpoint place(host, config.port);
  acceptor.open(place.protocol());
  acceptor.set_option(asio::socket_base::reuse_address(true));
  acceptor.bind(place, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    throw Error(ErrorCode::kIo, config.host + ":" + std::to_string(config.port) +
                                    ": cannot be listened at (" + error.message() +
                                    "); choose another --port");
  std::mutex making;
  std::list<Served> served;
  ready(acceptor.local_endpoint().port());
  while (StopRequested() == 0) {
    auto own = std::make_unique<asio::io_context>();
    std::optional<beast::error_code> result;
    asio::ip::tcp::socket socket(*own);
    acceptor.async_accept(socket, [&result](beast::error_code code) { result = code; });
    context.restart();
    while (!result && StopRequested() == 0) context.run_one_for(std::chrono::milliseconds(100));
    if (!result) {
      acceptor.close();
      while (!result) context.run_one();
      break;
    }
    std::erase_if(served, [](Served& one) {
      if (one.over) one.thread.join();
      return one.over.load();
    });
    if (*result || served.size() >= kMostConnections) continue;
    Served& one = served.emplace_back();
    one.thread = std::thread([&config, &make, &making, &one, own = std::move(own),
                              socket = std::move(socket)]() mutable {
      try {
        std::unique_ptr<LonePolicy> policy;
        {
          const std::scoped_lock lock(making);
          policy = make();
        }
        Connection(std::move(own), std::move(socket)).Serve(config, *policy);
      } catch (const std::exception&) {
        // who connected sees that the connection ends; the others go on
      }
      one.over = true;
    });
  }
  for (Served& one : served) one.thread.join();
}

}  // namespace doorforge
