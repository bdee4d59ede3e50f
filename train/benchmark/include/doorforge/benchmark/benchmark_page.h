// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/benchmark/benchmark_result.h"

namespace doorforge {

/// The result as one HTML page for people: the paper's table beside ours, which rows differ, the
/// spread over trainings, budgets, and a link to each report, which has films of what failed. It
/// asks no network for anything and is well-formed XML too; equal results give equal bytes.
std::string BenchmarkPage(const BenchmarkResult& result);

/// Writes benchmark.html and benchmark.json into a folder. @returns The page's path, absolute.
std::filesystem::path WriteBenchmark(const BenchmarkResult& result,
                                     const std::filesystem::path& folder);

}  // namespace doorforge
