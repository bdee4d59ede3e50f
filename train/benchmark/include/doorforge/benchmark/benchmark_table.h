// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace doorforge {

/// Who is judged, a row of the benchmark's table.
struct BenchmarkRow {
  std::string name;
  std::string title;
  std::vector<double> paper = {};  ///< The paper's rates, in the order of Category; may be empty.
  std::string pipeline = {};       ///< A preset that trains what `evaluate` names; may be empty.
  std::vector<std::string>
      evaluate;  ///< Arguments of `doorforge eval`, with {steps} of it and {data}.
  /// Arguments of `doorforge compose --all`: the row is judged on doors of its own, of the same
  /// bodies and handles. Empty: on those of the others.
  std::vector<std::string> compose = {};
  double core_seconds = 1;  ///< A door and seed of the evaluation takes it.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("name", self.name);
    visit("title", self.title);
    visit("paper", self.paper);
    visit("pipeline", self.pipeline);
    visit("evaluate", self.evaluate);
    visit("compose", self.compose);
    visit("core_seconds", self.core_seconds);
  }
};

/// Which rows are judged, on how many doors, after how many trainings.
struct BenchmarkSize {
  std::string about;
  std::vector<std::string> rows;       ///< Names of rows of data/benchmarks/rows.yaml, or of `own`.
  std::vector<BenchmarkRow> own = {};  ///< Rows of the user's; they go before others of their name.
  int doors = 6;                       ///< Each category has so many, on either side.
  int seeds = 3;                       ///< Scenes of each door.
  int trainings = 1;  ///< Each row that is trained has so many; their seeds follow `seed`.
  std::uint64_t seed = 7;
  /// "key=value" of the pipelines that train; each pipeline is told those that it has.
  std::vector<std::string> settings;
  /// Arguments of `doorforge eval` of every row, before its own: who is judged, where the rows are
  /// conditions. Empty: each row says it.
  std::vector<std::string> evaluate = {};
  std::string split = "full:test";  ///< The side of held-out doors.
  std::string unseen_split = "full:unseen_categories";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("about", self.about);
    visit("rows", self.rows);
    visit("own", self.own);
    visit("doors", self.doors);
    visit("seeds", self.seeds);
    visit("trainings", self.trainings);
    visit("seed", self.seed);
    visit("settings", self.settings);
    visit("evaluate", self.evaluate);
    visit("split", self.split);
    visit("unseen_split", self.unseen_split);
  }
};

/// A benchmark: its size, and its rows in their order.
struct Benchmark {
  std::string name;
  BenchmarkSize size;
  std::vector<BenchmarkRow> rows;

  int TrainingsOf(const BenchmarkRow& row) const {
    return row.pipeline.empty() ? 1 : size.trainings;
  }
};

/// Names of the sizes in data/benchmarks.
std::vector<std::string> BenchmarkSizes();

/// What each size is about, a line each, for the help.
std::string SizesText();

/// Reads data/benchmarks/rows.yaml and a size.
///
/// @param name "quick", or a path that ends with ".yaml".
/// @param changes "key=value" of the size.
/// @param rows Names in the place of the size's; empty: the size's.
/// @throws Error(kInvalidArgument) on an unknown size or row, with the nearest and all there are;
///     Error(kInvalidConfig) on numbers below 1 and as LoadConfig().
Benchmark ReadBenchmark(const std::string& name, const std::vector<std::string>& changes,
                        const std::vector<std::string>& rows);

}  // namespace doorforge
