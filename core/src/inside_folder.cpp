// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/inside_folder.h"

#include <algorithm>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void ThrowLeaves(const std::string& name, const std::string& named_by,
                              const std::string& how) {
  throw Error(ErrorCode::kFormat, named_by + ": \"" + name + "\" " + how +
                                      "; allowed are files inside the object's folder, named "
                                      "relative to it");
}

bool LiesIn(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

}  // namespace

fs::path FileInside(const fs::path& folder, const std::string& name, const std::string& named_by) {
  const fs::path relative(name);
  if (name.empty()) ThrowLeaves(name, named_by, "is empty");
  if (relative.is_absolute()) ThrowLeaves(name, named_by, "is an absolute path");
  if (name.find("://") != std::string::npos) ThrowLeaves(name, named_by, "has a scheme");
  if (std::find(relative.begin(), relative.end(), "..") != relative.end())
    ThrowLeaves(name, named_by, "leaves the folder");
  const fs::path file = folder / relative;
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw Error(ErrorCode::kMissing, file.string() + ": missing; " + named_by + " names it");
  if (!LiesIn(fs::canonical(file), fs::canonical(folder)))
    ThrowLeaves(name, named_by, "is a link out of the folder");
  return file;
}

}  // namespace doorforge
