// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/published_schemas.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

constexpr std::string_view kSchemaEnding = ".schema.json";

std::filesystem::path SchemaFolder() {
  std::filesystem::path folder = DataFolder() / "schemas";
  if (!std::filesystem::is_directory(folder))
    throw Error(ErrorCode::kMissing, folder.string() + ": no such folder");
  return folder;
}

}  // namespace

std::vector<std::string> PublishedSchemas() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SchemaFolder())) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(kSchemaEnding))
      names.push_back(file.substr(0, file.size() - kSchemaEnding.size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string PublishedSchema(const std::string& name) {
  const std::vector<std::string> names = PublishedSchemas();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error(ErrorCode::kInvalidArgument, "no schema \"" + name + "\"; did you mean " +
                                                 NearestName(name, names) +
                                                 "? `doorforge schema` lists all");
  return ReadFile(SchemaFolder() / (name + std::string(kSchemaEnding)));
}

}  // namespace doorforge
