// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/process_group.h"

#include <charconv>
#include <cstdlib>
#include <string>

#include "doorforge/core/error.h"

#ifdef DOORFORGE_HAS_GLOO
#ifndef USE_C10D_GLOO  // without it the header declares nothing; libtorch's CMake files may set it
#define USE_C10D_GLOO
#endif
#include <ATen/ATen.h>
#include <torch/csrc/distributed/c10d/ProcessGroupGloo.hpp>
#include <torch/csrc/distributed/c10d/TCPStore.hpp>
#endif

namespace doorforge {
namespace {

class OneProcess : public ProcessGroup {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  std::vector<float> Gather(std::span<const float> mine) override {
    return {mine.begin(), mine.end()};
  }
  void Sum(std::span<float>) override {}
};

std::string Variable(const char* name) {
  const char* text = std::getenv(name);
  Require(text != nullptr && *text != '\0', ErrorCode::kInvalidArgument,
          std::string("--nodes: the variable ") + name +
              " is not set; start the processes with torchrun, or set RANK, WORLD_SIZE, "
              "MASTER_ADDR and MASTER_PORT");
  return text;
}

int NumberIn(const char* name, int least, int most) {
  const std::string text = Variable(name);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && end == text.data() + text.size();
  Require(number && value >= least && value <= most, ErrorCode::kInvalidArgument,
          "--nodes: " + std::string(name) + "=" + text + ", expected a number from " +
              std::to_string(least) + " to " + std::to_string(most));
  return value;
}

struct RankPlace {
  int rank;
  int size;
  std::string host;
  int port;
};

RankPlace PlaceFromEnvironment() {
  RankPlace place;
  place.size = NumberIn("WORLD_SIZE", 1, 8);
  Require((place.size & (place.size - 1)) == 0, ErrorCode::kInvalidArgument,
          "--nodes: WORLD_SIZE=" + std::to_string(place.size) + ", expected 1, 2, 4 or 8");
  place.rank = NumberIn("RANK", 0, place.size - 1);
  place.host = Variable("MASTER_ADDR");
  place.port = NumberIn("MASTER_PORT", 1, 65535);
  return place;
}

#ifdef DOORFORGE_HAS_GLOO

// libtorch's own back end over TCP.
class GlooGroup : public ProcessGroup {
 public:
  explicit GlooGroup(const RankPlace& place) : place_(place) {
    c10d::TCPStoreOptions store;
    store.port = static_cast<std::uint16_t>(place.port);
    store.isServer = place.rank == 0;
    store.numWorkers = static_cast<std::size_t>(place.size);
    const auto options = c10d::ProcessGroupGloo::Options::create();
    options->devices.push_back(c10d::ProcessGroupGloo::createDefaultDevice());
    options->timeout = std::chrono::minutes(5);
    group_ = c10::make_intrusive<c10d::ProcessGroupGloo>(
        c10::make_intrusive<c10d::TCPStore>(place.host, store), place.rank, place.size, options);
  }

  int rank() const override { return place_.rank; }
  int size() const override { return place_.size; }

  std::vector<float> Gather(std::span<const float> mine) override {
    const auto count = static_cast<std::int64_t>(mine.size());
    std::vector<float> all(mine.size() * static_cast<std::size_t>(place_.size));
    // the back end only reads what it sends
    std::vector<at::Tensor> sent = {at::from_blob(const_cast<float*>(mine.data()), {count})};
    std::vector<std::vector<at::Tensor>> received(1);
    for (int rank = 0; rank < place_.size; ++rank)
      received[0].push_back(at::from_blob(all.data() + rank * count, {count}));
    Await([&] { group_->allgather(received, sent)->wait(); });
    return all;
  }

  // Recursive doubling sends half the bytes of a gather, and none copied on the way. Both of a pair
  // add the same two numbers, and addition commutes to the last bit.
  void Sum(std::span<float> mine) override {
    const auto count = static_cast<std::int64_t>(mine.size());
    theirs_.resize(mine.size());
    for (int stride = 1; stride < place_.size; stride *= 2) {
      const int peer = place_.rank ^ stride;
      std::vector<at::Tensor> sent = {at::from_blob(mine.data(), {count})};
      std::vector<at::Tensor> received = {at::from_blob(theirs_.data(), {count})};
      Await([&] {
        const auto receiving = group_->recv(received, peer, kSumTag);
        group_->send(sent, peer, kSumTag)->wait();
        receiving->wait();
      });
      for (std::size_t k = 0; k < mine.size(); ++k) mine[k] += theirs_[k];
    }
  }

  template <class Exchange>
  static void Await(const Exchange& exchange) {
    try {
      exchange();
    } catch (const std::exception& error) {
      throw Error(ErrorCode::kIncomplete,
                  "another process of this training is gone; start all of them again with "
                  "--resume (" +
                      FirstLine(error.what()) + ")");
    }
  }

  static std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

 private:
  static constexpr int kSumTag = 1;

  RankPlace place_;
  c10::intrusive_ptr<c10d::ProcessGroupGloo> group_;
  std::vector<float> theirs_;
};

std::unique_ptr<ProcessGroup> Join(const RankPlace& place) {
  try {
    return std::make_unique<GlooGroup>(place);
  } catch (const std::exception& error) {
    throw Error(ErrorCode::kIo, "--nodes: process " + std::to_string(place.rank) + " of " +
                                    std::to_string(place.size) + " does not reach the others at " +
                                    place.host + ":" + std::to_string(place.port) + ": " +
                                    GlooGroup::FirstLine(error.what()));
  }
}

#else

std::unique_ptr<ProcessGroup> Join(const RankPlace&) {
  throw Error(ErrorCode::kInvalidArgument,
              "--nodes: this build of doorforge has no distributed back end: libtorch without "
              "Gloo, or its headers were not found (Debian: libgloo-dev)");
}

#endif

}  // namespace

std::unique_ptr<ProcessGroup> SingleProcessGroup() { return std::make_unique<OneProcess>(); }

std::unique_ptr<ProcessGroup> ProcessGroupFromEnvironment() {
  const RankPlace place = PlaceFromEnvironment();
  return place.size == 1 ? SingleProcessGroup() : Join(place);
}

}  // namespace doorforge
