// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// What libFuzzer calls (https://llvm.org/docs/LibFuzzer.html), for all programs of this folder.

#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <typeinfo>

#include <sys/time.h>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

#include "fuzz_target.h"
#include "mutators.h"

namespace doorforge::fuzz {
namespace {

const Target* chosen = nullptr;
bool telling = false;
nlohmann::ordered_json told;

// An input may take a second of processor time, with sanitizers; libFuzzer's own limit counts the
// time on the wall, which a busy machine uses up by itself.
constexpr int kTicks = 4;
std::atomic<int> ticks_of_input = 0;

void Tick(int) {
  if (++ticks_of_input <= kTicks) return;
  constexpr char kMessage[] = "finding: an input takes more than a second of processor time\n";
  std::fputs(kMessage, stderr);
  std::abort();
}

void WatchTime() {
  struct sigaction action {};
  action.sa_handler = Tick;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGPROF, &action, nullptr);
  const timeval quarter{0, 1'000'000 / kTicks};
  const itimerval every{quarter, quarter};
  ::setitimer(ITIMER_PROF, &every, nullptr);
}

// A line for one input.
void Answer(const char* key, const nlohmann::ordered_json& answer) {
  if (telling) std::printf("%s\n", JsonText({{key, answer}}).c_str());
}

void Choose() {
  telling = std::getenv("DOORFORGE_FUZZ_TELL") != nullptr;
  const char* name = std::getenv("DOORFORGE_FUZZ_TARGET");
  for (const Target& target : Targets()) {
    if (name != nullptr && target.name == name) chosen = &target;
  }
  if (chosen != nullptr) return;
  std::fprintf(stderr, "DOORFORGE_FUZZ_TARGET chooses one of:\n");
  for (const Target& target : Targets())
    std::fprintf(stdout, "%.*s\n", static_cast<int>(target.name.size()), target.name.data());
  std::exit(2);
}

}  // namespace

void Expect(bool holds, std::string_view promise) {
  if (holds) return;
  std::fprintf(stderr, "finding: it does not hold that %.*s\n", static_cast<int>(promise.size()),
               promise.data());
  std::abort();
}

bool Telling() { return telling; }

void Tell(nlohmann::ordered_json what) { told = std::move(what); }

}  // namespace doorforge::fuzz

using namespace doorforge;

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  fuzz::Choose();
  fuzz::WatchTime();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  fuzz::ticks_of_input = 0;
  try {
    fuzz::told = nullptr;
    fuzz::chosen->read({reinterpret_cast<const char*>(bytes), size});
    fuzz::Answer("read", fuzz::told);
  } catch (const Error& error) {
    fuzz::Answer("refused", error.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "finding: %s, which is no Error: %s\n", typeid(error).name(),
                 error.what());
    std::abort();
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return fuzz::Mutate(fuzz::chosen->shape, {bytes, most}, size, seed);
}
