// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/benchmark/benchmark_table.h"

#include <algorithm>
#include <filesystem>

#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRows = "rows";

fs::path BenchmarkFolder() { return DataFolder() / "benchmarks"; }

struct RowTable {
  std::vector<BenchmarkRow> rows;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("rows", self.rows);
  }
};

[[noreturn]] void Unknown(const std::string& what, const std::string& name,
                          const std::vector<std::string>& known) {
  std::string all;
  for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
  throw Error(ErrorCode::kInvalidArgument, what + " " + name + ": there is none; did you mean \"" +
                                               NearestName(name, known) + "\"? There are " + all);
}

fs::path FileOf(const std::string& name) {
  if (name.ends_with(".yaml")) return name;
  const std::vector<std::string> sizes = BenchmarkSizes();
  if (std::ranges::find(sizes, name) == sizes.end()) Unknown("benchmark", name, sizes);
  return BenchmarkFolder() / (name + ".yaml");
}

BenchmarkRow RowNamed(const std::vector<BenchmarkRow>& rows, const std::string& name) {
  const auto found = std::ranges::find(rows, name, &BenchmarkRow::name);
  if (found != rows.end()) return *found;
  std::vector<std::string> known;
  for (const BenchmarkRow& row : rows) known.push_back(row.name);
  Unknown("--rows", name, known);
}

}  // namespace

std::vector<std::string> BenchmarkSizes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(BenchmarkFolder())) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == ".yaml" && name != kRows) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

Benchmark ReadBenchmark(const std::string& name, const std::vector<std::string>& changes,
                        const std::vector<std::string>& rows) {
  const fs::path file = FileOf(name);
  Benchmark benchmark{file.stem().string(), LoadConfig<BenchmarkSize>(file.string(), changes), {}};
  const std::string table = (BenchmarkFolder() / (std::string(kRows) + ".yaml")).string();
  std::vector<BenchmarkRow> known = benchmark.size.own;
  const RowTable shipped = LoadConfig<RowTable>(table, {});
  known.insert(known.end(), shipped.rows.begin(), shipped.rows.end());
  if (!rows.empty()) benchmark.size.rows = rows;
  for (const std::string& row : benchmark.size.rows) benchmark.rows.push_back(RowNamed(known, row));
  const BenchmarkSize& size = benchmark.size;
  Require(!benchmark.rows.empty() && size.doors >= 1 && size.seeds >= 1 && size.trainings >= 1,
          ErrorCode::kInvalidConfig,
          file.string() + ": rows, doors, seeds and trainings must be at least one each");
  return benchmark;
}

std::string SizesText() {
  std::string lines;
  for (const std::string& name : BenchmarkSizes()) {
    const std::string space(name.size() < 8 ? 8 - name.size() : 1, ' ');
    lines += "  " + name + space + ReadBenchmark(name, {}, {}).size.about + "\n";
  }
  return lines;
}

}  // namespace doorforge
