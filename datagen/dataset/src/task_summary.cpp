// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/task_summary.h"

#include <cstdio>

namespace doorforge {

nlohmann::ordered_json TaskSummaryToJson(const CollectSummary& summary,
                                         const CollectionTask& task) {
  return {{"schema", "doorforge.collection_task"},
          {"schema_version", 1},
          {"task", task.number},
          {"tasks", task.count},
          {"shards", summary.shards},
          {"episodes", summary.written},
          {"failures", summary.failures},
          {"bytes", summary.bytes}};
}

std::string TaskSummaryText(const CollectSummary& summary, const CollectionTask& task,
                            const std::filesystem::path& folder) {
  char text[200];
  std::snprintf(text, sizeof text,
                "task %d/%d: %llu shards, %llu of %llu episodes succeeded, %.1f MiB in ",
                task.number, task.count, static_cast<unsigned long long>(summary.shards),
                static_cast<unsigned long long>(summary.written),
                static_cast<unsigned long long>(summary.planned),
                static_cast<double>(summary.bytes) / (1 << 20));
  return text + folder.string() + "\n";
}

}  // namespace doorforge
