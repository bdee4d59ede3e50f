// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/benchmark/benchmark_pipeline.h"
#include "doorforge/report/over_trainings.h"
#include "doorforge/report/success_statistics.h"

namespace doorforge {

/// What a row came to on both sides of the doors together.
struct BenchmarkRowResult {
  BenchmarkRow row;
  TrainingsSummary summary;          ///< Over its trainings.
  double train_minutes = 0;          ///< Core minutes expected of one of its trainings.
  std::vector<std::string> reports;  ///< Folders, below the benchmark's.
  /// Share of episodes of all trainings whose hinge passed 0, 1, ... 90 degrees, the mean of the
  /// categories that occur.
  std::vector<double> past_degree;
};

/// Whether two rows differ, on the same bodies, handles and seeds.
struct BenchmarkComparison {
  std::size_t first = 0;  ///< Index into BenchmarkResult::rows.
  std::size_t second = 0;
  ClusteredDifference
      difference;  ///< The second is so much over the first, in means over trainings.
};

struct BenchmarkResult {
  Benchmark benchmark;
  std::vector<BenchmarkRowResult> rows;
  std::vector<BenchmarkComparison> comparisons;  ///< Each row with the last.
};

/// Reads the reports of all parts.
///
/// @throws Error(kMissing or kFormat) as their reader, and Error(kInvalidArgument) unless all are
///     of the same bodies, handles and seeds.
BenchmarkResult ReadBenchmarkResult(const Benchmark& benchmark, const BenchmarkPlan& plan,
                                    const std::filesystem::path& out);

/// The paper's table beside ours, and the comparisons, for a terminal.
std::string BenchmarkText(const BenchmarkResult& result);
/// {"schema": "doorforge.benchmark", "rows": [{"name", "title", "paper", "success": as
/// `doorforge report --json`, "train_core_minutes", "reports", "past_degree"}], "comparisons":
/// [{"row", "with", "mean", "low", "high", "significant"}]}.
nlohmann::ordered_json BenchmarkToJson(const BenchmarkResult& result);

}  // namespace doorforge
