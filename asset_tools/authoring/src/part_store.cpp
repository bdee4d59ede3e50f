// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "part_store.h"

#include <system_error>

#include <fnmatch.h>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// False also for what can be no path, such as a name that is too long.
bool IsThere(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool IsPartFolder(const fs::path& folder) { return IsThere(folder / "part.json"); }

bool Matches(const std::string& glob, const std::string& name) {
  return ::fnmatch(glob.c_str(), name.c_str(), 0) == 0;
}

// folders of parts whose path is like the glob; only its last component may hold wildcards
std::set<fs::path> FoldersLike(const std::string& glob) {
  std::set<fs::path> folders;
  const fs::path path(glob);
  if (!path.has_parent_path() || !fs::is_directory(path.parent_path())) return folders;
  for (const auto& entry : fs::directory_iterator(path.parent_path())) {
    if (Matches(path.filename().string(), entry.path().filename().string()) &&
        IsPartFolder(entry.path()))
      folders.insert(entry.path());
  }
  return folders;
}

}  // namespace

bool IsGlob(const std::string& name) { return name.find_first_of("*?[") != std::string::npos; }

PartStore::PartStore(const fs::path& folder) : folder_(folder) {
  if (folder.empty()) {
    catalogue_ = ListRecipes(DataFolder());
    return;
  }
  if (!fs::is_directory(folder))
    throw Error(ErrorCode::kMissing, folder.string() + ": no such folder of parts");
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (IsPartFolder(entry.path())) folders_.insert(entry.path());
  }
}

std::vector<std::string> PartStore::All() const {
  std::vector<std::string> names;
  for (const RecipeFile& entry : catalogue_) names.push_back(entry.id);
  for (const fs::path& folder : folders_) names.push_back(folder.string());
  return names;
}

std::vector<std::string> PartStore::Matching(const std::string& wanted, PartRole role) const {
  if (!IsGlob(wanted)) return {wanted};
  std::vector<std::string> names;
  for (const RecipeFile& entry : catalogue_) {
    if (entry.role == role && Matches(wanted, entry.id)) names.push_back(entry.id);
  }
  for (const fs::path& folder : folders_) {
    if (Matches(wanted, folder.filename().string())) names.push_back(folder.string());
  }
  for (const fs::path& folder : FoldersLike(wanted)) names.push_back(folder.string());
  if (names.empty())
    throw Error(ErrorCode::kMissing, "no part is called like \"" + wanted +
                                         "\"; `doorforge catalog list` shows the catalogue");
  return names;
}

fs::path PartStore::FolderOf(const std::string& name) const {
  if (IsPartFolder(name)) return name;
  const bool in_store = !folder_.empty() && name.find('/') == std::string::npos;
  return in_store && IsPartFolder(folder_ / name) ? folder_ / name : fs::path();
}

bool PartStore::IsToImport(const std::string& name) const {
  if (!FolderOf(name).empty() || IsGlob(name)) return false;
  return IsThere(name) || fs::path(name).has_extension();
}

Part PartStore::Load(const std::string& name) const {
  if (const fs::path folder = FolderOf(name); !folder.empty()) return ReadPart(folder);
  if (name.find('/') != std::string::npos || IsThere(name))
    throw Error(ErrorCode::kMissing, name +
                                         ": no part.json there; `doorforge import` and "
                                         "`doorforge catalog build` write parts");
  return catalogue_.empty() ? BuildCataloguePart(DataFolder(), name)
                            : BuildCataloguePart(FindRecipe(catalogue_, name));
}

}  // namespace doorforge
