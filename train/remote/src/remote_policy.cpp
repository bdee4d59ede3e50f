// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/remote/remote_policy.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/schemas/fallible.h"
#include "doorforge/schemas/stage_switch.h"

#include "address.h"
#include "link.h"
#include "message.h"

namespace doorforge {
namespace {

using internal::Link;
using internal::NumpyArray;
using internal::Value;

constexpr std::size_t kNumbers = std::tuple_size_v<ActionNumbers>;

std::string ShapeText(const std::vector<std::int64_t>& shape) {
  std::string text;
  for (const std::int64_t length : shape)
    text += (text.empty() ? "" : ", ") + std::to_string(length);
  return "(" + text + (shape.size() == 1 ? ",)" : ")");
}

/// The rows of an answer, each nine finite numbers.
std::vector<Action> ActionsOf(const Value& answer) {
  const Value* found = answer.Find("actions");
  if (found == nullptr)
    throw Error(ErrorCode::kFormat,
                "the answer has no \"actions\": an array (n, 9) or (9,) of float32");
  const auto* array = found->As<NumpyArray>();
  if (array == nullptr)
    throw Error(ErrorCode::kFormat,
                "actions: expected an array of numpy, packed as msgpack_numpy does");
  const auto& shape = array->shape;
  const bool fits = !shape.empty() && shape.size() <= 2 && shape.back() == kNumbers &&
                    (shape.size() == 1 || shape[0] > 0);
  if (!fits)
    throw Error(ErrorCode::kFormat,
                "actions: shape " + ShapeText(shape) + ", expected (n, 9) or (9,)");
  const std::vector<double> numbers = array->Numbers("actions");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i]))
      throw Error(ErrorCode::kFormat, "actions: number " + std::to_string(i) + " is " +
                                          std::to_string(numbers[i]) + ", expected a finite one");
  }
  std::vector<Action> actions;
  for (std::size_t i = 0; i < numbers.size(); i += kNumbers) {
    ActionNumbers row{};
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(i), kNumbers, row.begin());
    actions.push_back(FromNumbers(row));
  }
  return actions;
}

// What an answer says of the handle; nothing: nothing.
std::optional<bool> TurnedOf(const Value& answer) {
  const Value* found = answer.Find("turned");
  if (found == nullptr) return std::nullopt;
  const bool* turned = found->As<bool>();
  if (turned == nullptr)
    throw Error(ErrorCode::kFormat,
                "turned: expected true or false, whether the handle is turned once the actions "
                "have been carried out");
  return *turned;
}

class RemotePolicy : public Policy, public Fallible, public StageSwitch {
 public:
  RemotePolicy(std::unique_ptr<Link> link, RemotePolicySettings settings)
      : link_(std::move(link)), settings_(std::move(settings)) {}

  void Reset() override {
    failure_.clear();
    planned_.clear();
    told_ = {};
    begins_ = true;
  }

  Action Act(const Observation& observation) override {
    try {
      if (!failure_.empty()) return NoAction();
      if (planned_.empty()) Ask(observation);
      const Action action = planned_.front();
      planned_.pop_front();
      return action;
    } catch (const Error& error) {
      failure_ = error.what();
      // an answer that still comes would be taken for the next one
      link_->Close();
      return NoAction();
    }
  }

  void ForgetFailure() override { failure_.clear(); }
  std::string Failure() const override { return failure_; }

  bool Says() const override { return told_.has_value(); }
  // An answer speaks of the instant after the last of its actions.
  bool Turned() const override { return planned_.empty() && told_.value_or(false); }

 private:
  static Action NoAction() {
    Action action;
    action.position_delta_m.setConstant(std::numeric_limits<double>::quiet_NaN());
    return action;
  }

  void Ask(const Observation& observation) {
    const auto points = static_cast<std::int64_t>(observation.cloud.xyz.size() / 3);
    Value::Map request;
    request["cloud"] = {internal::ArrayOf(observation.cloud.xyz.data(), {points, 3})};
    if (settings_.remembers) request["remembered"] = {true};
    request["proprioception"] = {internal::ArrayOf(observation.proprioception.data(), {32})};
    request["stage"] = {settings_.stage};
    request["prompt"] = {
        std::string(settings_.stage == "open" ? "open the door" : "turn the handle")};
    request["episode_start"] = {begins_};
    const std::string message = internal::Packed({std::move(request)});
    std::string answer;
    try {
      answer = link_->Exchange(message);
    } catch (const Error& error) {
      // whoever went away between two episodes may be there again; within one it has forgotten
      const bool may_be_back = begins_ && has_answered_ && error.code() == ErrorCode::kMissing;
      has_answered_ = false;
      if (!may_be_back) throw;
      answer = link_->Exchange(message);
    }
    has_answered_ = true;
    begins_ = false;
    const Value unpacked = internal::Unpacked(answer);
    const std::vector<Action> actions = ActionsOf(unpacked);
    told_ = TurnedOf(unpacked);
    const auto count = std::min(actions.size(), static_cast<std::size_t>(settings_.chunk));
    planned_.assign(actions.begin(), actions.begin() + static_cast<std::ptrdiff_t>(count));
  }

  std::unique_ptr<Link> link_;
  RemotePolicySettings settings_;
  std::deque<Action> planned_;
  std::optional<bool> told_;  // by the last answer, whether the handle is turned
  bool begins_ = true;
  bool has_answered_ = false;  // since it was last asked in vain
  std::string failure_;
};

// Greetings are free: whatever is not meant for us is nothing.
ServerGreeting Understood(const std::string& message) {
  ServerGreeting greeting;
  try {
    const Value unpacked = internal::Unpacked(message);
    const Value* remembered = unpacked.Find("remembered");
    const Value* finer = remembered == nullptr ? nullptr : remembered->Find("finer");
    const Value* within = remembered == nullptr ? nullptr : remembered->Find("within_m");
    if (finer == nullptr || within == nullptr) return greeting;
    const auto* scale = finer->As<std::int64_t>();
    const auto* radius = within->As<double>();
    if (scale != nullptr && radius != nullptr)
      greeting.remembered = {static_cast<int>(*scale), *radius};
  } catch (const Error&) {
    // not MessagePack as it is here
  }
  return greeting;
}

void Check(const RemotePolicySettings& settings) {
  Require(settings.timeout_s > 0 && settings.timeout_s <= 1e5 && settings.chunk >= 1,
          ErrorCode::kInvalidArgument,
          "--policy-timeout must be positive and --policy-chunk at least 1");
}

}  // namespace

bool IsServerAddress(const std::string& word) { return word.starts_with("ws://"); }

std::unique_ptr<Policy> MakeServedPolicy(const std::string& address,
                                         const RemotePolicySettings& settings) {
  Check(settings);
  return std::make_unique<RemotePolicy>(internal::MakeWebSocketLink(address, settings.timeout_s),
                                        settings);
}

std::unique_ptr<Policy> MakeCommandPolicy(const std::string& command,
                                          const RemotePolicySettings& settings) {
  Check(settings);
  return std::make_unique<RemotePolicy>(internal::MakeCommandLink(command, settings.timeout_s),
                                        settings);
}

ServerGreeting GreetingOf(const std::string& address, const RemotePolicySettings& settings) {
  Check(settings);
  try {
    return Understood(internal::MakeWebSocketLink(address, settings.timeout_s)->Open());
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kMissing && error.code() != ErrorCode::kIo) throw;
    throw Error(ErrorCode::kMissing,
                std::string(error.what()) + "; start the policy's server first");
  }
}

}  // namespace doorforge
