// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "doorforge/dataset/collection_status.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostListed = 5;

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::string Duration(double seconds) {
  const auto whole = static_cast<long long>(std::max(0.0, seconds) + 0.5);
  char text[48];
  std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
  return text;
}

std::string WithDigits(double value, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string Counted(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::uint64_t Bytes(const CollectionStatus& status) {
  std::uint64_t sum = 0;
  for (const ShardStatus& shard : status.shards) sum += shard.bytes;
  return sum;
}

Json ShardToJson(const ShardStatus& shard, double now_s) {
  return {{"shard", shard.name},
          {"place", shard.place},
          {"state", NameOf(shard.state)},
          {"planned", shard.planned},
          {"kept", shard.kept},
          {"failed", shard.failed},
          {"idle_s", shard.end_s > 0 ? Json(std::max(0.0, now_s - shard.end_s)) : Json(nullptr)}};
}

Json TaskToJson(const TaskStatus& task) {
  return {{"task", task.number},
          {"shards", task.shards},
          {"done_shards", task.done_shards},
          {"planned", task.planned},
          {"run", task.run}};
}

std::string ShardsLine(const CollectionStatus& status) {
  std::string line = std::to_string(status.Count(ShardState::kDone)) + " of " +
                     std::to_string(status.shards.size()) + " done";
  const auto add = [&](ShardState state, const char* words) {
    if (status.Count(state) > 0) line += ", " + std::to_string(status.Count(state)) + words;
  };
  add(ShardState::kBeingWritten, " being written");
  add(ShardState::kBegun, " begun and left");
  add(ShardState::kOpen, " open");
  return line;
}

std::string EpisodesLine(const CollectionStatus& status) {
  const std::uint64_t run = status.Kept() + status.Failed();
  const double share = status.Planned() > 0 ? 100.0 * static_cast<double>(run) /
                                                  static_cast<double>(status.Planned())
                                            : 0;
  return std::to_string(run) + " of " + std::to_string(status.Planned()) + " run (" +
         WithDigits(share, 1) + " %), " + std::to_string(status.Kept()) + " kept, " +
         WithDigits(static_cast<double>(Bytes(status)) / (1 << 20), 1) + " MiB";
}

std::string RateLine(const CollectionStatus& status) {
  if (!status.episodes_per_s) return "";
  // slow ones are told an hour, since 0.00 tells nothing
  const double rate = *status.episodes_per_s;
  std::string line = rate >= 0.1 ? WithDigits(rate, 2) + " episodes a second"
                                 : WithDigits(3600 * rate, 1) + " episodes an hour";
  if (status.SecondsLeft()) line += ", " + Duration(*status.SecondsLeft()) + " left";
  return line;
}

std::string FailuresLine(const CollectionStatus& status) {
  std::vector<std::pair<std::uint64_t, std::string>> causes;
  for (const auto& [cause, count] : status.failures) causes.emplace_back(count, cause);
  std::sort(causes.rbegin(), causes.rend());
  std::string line;
  for (const auto& [count, cause] : causes)
    line += (line.empty() ? "" : ", ") + cause + " " + std::to_string(count);
  return line;
}

std::string SlowestLine(const CollectionStatus& status, double now_s) {
  std::string line;
  if (const TaskStatus* task = status.SlowestTask())
    line = "task " + std::to_string(task->number) + "/" + std::to_string(status.tasks.size()) +
           ": " + std::to_string(task->run) + " of " + Counted(task->planned, "episode");
  if (const ShardStatus* shard = status.Slowest())
    line += (line.empty() ? "" : "; ") + shard->name + ": " +
            std::to_string(shard->kept + shard->failed) + " of " +
            Counted(shard->planned, "episode") + ", the last " + Duration(now_s - shard->end_s) +
            " ago";
  return line;
}

// "open/train/shard-000003 (number 3 of the plan)", of those that nobody writes.
std::string LeftShards(const CollectionStatus& status) {
  std::string names;
  std::size_t count = 0;
  for (const ShardStatus& shard : status.shards) {
    if (shard.state != ShardState::kBegun && shard.state != ShardState::kOpen) continue;
    if (++count > kMostListed) continue;
    names += (names.empty() ? "" : ", ") + shard.name + " (number " + std::to_string(shard.place) +
             (status.tasks.empty() ? ""
                                   : ", task " + std::to_string(shard.place % status.tasks.size()) +
                                         "/" + std::to_string(status.tasks.size())) +
             ")";
  }
  if (count > kMostListed) names += " and " + std::to_string(count - kMostListed) + " more";
  return names;
}

std::string NextStep(const CollectionStatus& status) {
  if (status.is_complete) return "complete; `doorforge dataset info " + status.folder + "`";
  if (status.Count(ShardState::kDone) == status.shards.size())
    return "all shards are there; `doorforge dataset merge " + status.folder +
           "` makes it complete";
  if (status.Count(ShardState::kBeingWritten) > 0)
    return "it is being collected; --watch looks again and again" +
           std::string(status.Count(ShardState::kBegun) > 0
                           ? "; of what was left, the same `datagen` command goes on"
                           : "");
  return "nobody writes; the same `datagen` command goes on, of tasks i/N those to which shard k "
         "belongs, i = k mod N: " +
         LeftShards(status);
}

std::string Row(const std::string& name, const std::string& text) {
  return text.empty() ? "" : name + std::string(11 - name.size(), ' ') + text + "\n";
}

}  // namespace

Json StatusToJson(const CollectionStatus& status, double now_s) {
  Json unfinished = Json::array();
  for (const ShardStatus& shard : status.shards)
    if (shard.state != ShardState::kDone) unfinished.push_back(ShardToJson(shard, now_s));
  Json tasks = Json::array();
  for (const TaskStatus& task : status.tasks) tasks.push_back(TaskToJson(task));
  const ShardStatus* slowest = status.Slowest();
  const TaskStatus* slowest_task = status.SlowestTask();
  return {{"schema", "doorforge.collection_status"},
          {"schema_version", 1},
          {"folder", status.folder},
          {"stage", status.stage},
          {"complete", status.is_complete},
          {"shards",
           {{"planned", status.shards.size()},
            {"done", status.Count(ShardState::kDone)},
            {"being_written", status.Count(ShardState::kBeingWritten)},
            {"begun", status.Count(ShardState::kBegun)},
            {"open", status.Count(ShardState::kOpen)}}},
          {"episodes",
           {{"planned", status.Planned()},
            {"run", status.Kept() + status.Failed()},
            {"kept", status.Kept()},
            {"failed", status.Failed()}}},
          {"bytes", Bytes(status)},
          {"success_rate", OrNull(status.SuccessRate())},
          {"failures", status.failures},
          {"episodes_per_s", OrNull(status.episodes_per_s)},
          {"seconds_left", OrNull(status.SecondsLeft())},
          {"slowest_shard", slowest != nullptr ? Json(slowest->name) : Json(nullptr)},
          {"slowest_task", slowest_task != nullptr ? Json(slowest_task->number) : Json(nullptr)},
          {"tasks", tasks},
          {"unfinished", unfinished},
          {"next", NextStep(status)}};
}

std::string StatusText(const CollectionStatus& status, double now_s) {
  const std::optional<double> success = status.SuccessRate();
  return status.folder + ": stage " + status.stage + "\n" + Row("shards", ShardsLine(status)) +
         Row("episodes", EpisodesLine(status)) +
         Row("success", success ? WithDigits(100 * *success, 1) + " %" : "") +
         Row("failures", FailuresLine(status)) + Row("rate", RateLine(status)) +
         Row("slowest", SlowestLine(status, now_s)) + Row("next", NextStep(status));
}

}  // namespace doorforge
