// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/task_number.h"

#include <charconv>
#include <cstdlib>
#include <optional>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr const char* kVariables[] = {"SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"};

// Digits and nothing else.
std::optional<int> PlainNumber(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string_view::npos)
    return std::nullopt;
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  return number;
}

[[noreturn]] void Refuse(const std::string& message) {
  throw Error(ErrorCode::kInvalidArgument, message);
}

}  // namespace

CollectionTask ParseTask(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto number = PlainNumber(text.substr(0, slash));
  std::optional<int> count;
  if (slash != std::string_view::npos) count = PlainNumber(text.substr(slash + 1));
  const std::string found = "--task \"" + std::string(text) + "\"";
  if (!number || !count)
    Refuse(found +
           ": expected a task's number and how many there are, such as 3/16; is a "
           "scheduler's variable empty?");
  if (*count < 1 || *count > kMostTasks)
    Refuse(found + ": 1 to " + std::to_string(kMostTasks) + " tasks are possible");
  if (*number >= *count)
    Refuse(found + ": tasks are numbered from 0 to " + std::to_string(*count - 1));
  return {*number, *count};
}

CollectionTask TaskFromEnvironment(int count, int offset) {
  std::optional<int> number;
  for (const char* variable : kVariables) {
    const char* text = std::getenv(variable);
    if (text == nullptr) continue;
    const std::optional<int> value = PlainNumber(text);
    if (!value || *value > kMostTasks)
      Refuse(std::string(variable) + " is \"" + text + "\", which is no task number");
    if (number && *number != *value)
      Refuse(std::string(kVariables[0]) + " and " + kVariables[1] +
             " are both set and differ; give --task i/N");
    number = value;
  }
  if (!number)
    Refuse(std::string("--tasks: neither ") + kVariables[0] + " nor " + kVariables[1] +
           " is set; run it in a job array, or give --task i/N");
  const int task = *number + offset;
  if (task < 0 || task >= count)
    Refuse("task " + std::to_string(task) + " (" + std::to_string(*number) + " and an offset of " +
           std::to_string(offset) + ") of " + std::to_string(count) +
           ": tasks are numbered from 0 to " + std::to_string(count - 1));
  return {task, count};
}

}  // namespace doorforge
