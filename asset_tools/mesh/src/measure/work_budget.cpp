// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/work_budget.h"

#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <utility>

#include <time.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr std::uint64_t kStepsPerReading = 10'000;

// The outermost of this thread; nothing where it may work as long as it likes.
thread_local constinit WorkBudget* current = nullptr;

double ThreadSeconds() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::string Seconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g s", seconds);
  return text;
}

}  // namespace

WorkBudget::WorkBudget(std::string name, double processor_s)
    : name_(std::move(name)), allowed_s_(processor_s), begin_s_(ThreadSeconds()) {
  Require(processor_s > 0, ErrorCode::kInvalidConfig, "max_seconds: must be positive");
  if (current == nullptr) current = this;
}

WorkBudget::~WorkBudget() {
  if (current == this) current = nullptr;
}

void CheckWork(unsigned steps) {
  WorkBudget* const budget = current;
  if (budget == nullptr) return;
  budget->steps_ += steps;
  if (budget->steps_ < kStepsPerReading) return;
  budget->steps_ = 0;
  if (ThreadSeconds() - budget->begin_s_ <= budget->allowed_s_) return;
  throw Error(ErrorCode::kFormat,
              budget->name_ + ": takes more than the " + Seconds(budget->allowed_s_) +
                  " of processor time allowed for one object; simplify its mesh, or allow more "
                  "with --max-seconds");
}

std::string CurrentProblem(const std::string& name) {
  try {
    throw;
  } catch (const Error& error) {
    const std::string problem = error.what();
    return problem.find(name) == std::string::npos ? name + ": " + problem : problem;
  } catch (const std::bad_alloc&) {
    return name + ": memory ran out; simplify its mesh";
  } catch (const std::filesystem::filesystem_error& error) {
    return name + ": " + error.path1().string() + ": " + error.code().message();
  } catch (const std::exception&) {
    return name + ": its content cannot be worked on; is it damaged?";
  }
}

}  // namespace doorforge
