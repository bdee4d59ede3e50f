// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/benchmark/benchmark_table.h"
#include "doorforge/pipeline/pipeline_graph.h"

namespace doorforge {

/// One evaluation: of a row, after one training, on one side of the doors.
struct BenchmarkPart {
  std::size_t row = 0;   ///< Index into Benchmark::rows.
  int training = 0;      ///< From 0.
  std::string report;    ///< Folder of its report, below the benchmark's.
  double train_seconds;  ///< Core seconds expected of the steps that it needs, shared or not.
};

/// A benchmark as a pipeline, and what its evaluations are.
struct BenchmarkPlan {
  Pipeline pipeline;
  std::vector<BenchmarkPart> parts;  ///< They are in the order of rows, trainings and sides.
};

/// Joins what trains the rows, see PipelineJoiner, and adds an evaluation of each row, training and
/// side of the doors, held-out ones first. Every row is judged on the same doors and seeds.
///
/// @throws Error(kInvalidConfig) as ReadPipeline(), if a row names a step that its pipeline does
///     not have, and on a setting that neither a row's pipeline nor any preset has.
BenchmarkPlan PlanBenchmark(const Benchmark& benchmark);

/// Judges all rows on the composed doors in these folders, instead of the catalogue's.
///
/// @throws Error(kInvalidArgument) if a row composes doors of its own, BenchmarkRow::compose.
void GiveDoors(const Benchmark& benchmark, const std::vector<std::string>& folders,
               BenchmarkPlan& plan);

}  // namespace doorforge
