// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/authoring/part_batch.h"

#include <exception>

#include <nlohmann/json.hpp>

#include "doorforge/catalogue/describe_catalogue.h"
#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge {

std::vector<std::string> BuildParts(std::span<const CatalogueEntry> entries,
                                    const std::filesystem::path& out, Existing existing,
                                    int threads) {
  RequireWritable(out);
  std::vector<std::string> problems(entries.size());
  Progress progress("building parts", entries.size());
  ParallelFor(entries.size(), threads, [&](std::size_t i) {
    try {
      if (StopRequested() != 0) throw Error(ErrorCode::kIncomplete, "stopped before its turn");
      StagedFolder staged(OutputBelow(out, entries[i].id), kPartFolder, existing);
      WritePart(BuildCataloguePart(entries[i]), staged.path());
      staged.Commit();
    } catch (const Error& error) {
      problems[i] = error.what();
    } catch (const std::exception&) {
      problems[i] = CurrentProblem(entries[i].id);
    }
    progress.Advance();
  });
  return problems;
}

nlohmann::ordered_json BuiltToJson(std::span<const CatalogueEntry> entries,
                                   std::span<const std::string> problems) {
  auto parts = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    nlohmann::ordered_json part = EntryToJson(entries[i]);
    part["built"] = problems[i].empty();
    part["message"] = problems[i];
    parts.push_back(std::move(part));
  }
  return {{"schema", "doorforge.catalog_build"}, {"schema_version", 1}, {"parts", parts}};
}

}  // namespace doorforge
