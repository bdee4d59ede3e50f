// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/importers/foreign_object.h"

#include "import_format.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::ImportFormat;

constexpr int kMaxDepth = 2;  // of folders below the source's own

const std::vector<ImportFormat>& Formats() {
  static const std::vector<ImportFormat> kFormats = [] {
    std::vector<ImportFormat> formats;
    for (const auto& format : internal::kImportFormats) formats.push_back(format());
    return formats;
  }();
  return kFormats;
}

const ImportFormat& FormatNamed(const std::string& name) {
  for (const ImportFormat& format : Formats()) {
    if (format.name == name) return format;
  }
  std::string allowed = "auto";
  for (const ImportFormat& format : Formats()) allowed += ", " + format.name;
  throw Error(ErrorCode::kInvalidArgument,
              "--format: unknown format \"" + name + "\"; allowed are " + allowed);
}

// the format that takes this file or folder; nothing if none does
const ImportFormat* FormatOf(const fs::path& path, const std::string& wanted, bool is_source) {
  if (wanted != "auto") {
    const ImportFormat& format = FormatNamed(wanted);
    return format.knows(path) ? &format : nullptr;
  }
  for (const ImportFormat& format : Formats()) {
    // a mesh among other files may be anything
    if (format.name == "mesh" && !is_source) continue;
    if (format.knows(path)) return &format;
  }
  return nullptr;
}

std::vector<ForeignSource> SearchFolder(const fs::path& folder, const std::string& wanted) {
  std::vector<ForeignSource> found;
  std::error_code error;
  auto entry = fs::recursive_directory_iterator(
      folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code unreachable;  // as a link to itself is, beside which the others count
    if (!entry->exists(unreachable)) continue;
    const ImportFormat* format = FormatOf(entry->path(), wanted, false);
    if (format != nullptr) found.push_back({entry->path(), format->name});
    if (!entry->is_directory(unreachable)) continue;
    if (format != nullptr || entry.depth() >= kMaxDepth) entry.disable_recursion_pending();
  }
  std::sort(found.begin(), found.end(),
            [](const ForeignSource& a, const ForeignSource& b) { return a.path < b.path; });
  return found;
}

[[noreturn]] void ThrowNothing(const fs::path& source, const std::string& wanted) {
  const std::string what = wanted == "auto" ? "an object of a known format" : "format " + wanted;
  std::string help = "give one object, or a folder that holds some up to three levels deep";
  if (wanted == "auto") help += "; loose meshes in a folder need --format mesh --role body|handle";
  throw Error(ErrorCode::kMissing, source.string() + ": holds nothing that is " + what + "; " +
                                       help + ". docs/import.md shows the formats");
}

}  // namespace

const std::vector<std::string>& ImportFormatNames() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const ImportFormat& format : Formats()) names.push_back(format.name);
    return names;
  }();
  return kNames;
}

std::vector<ForeignSource> FindObjects(const fs::path& source, const std::string& format) {
  if (format != "auto") FormatNamed(format);
  std::error_code error;
  if (!fs::exists(source, error))
    throw Error(ErrorCode::kMissing, source.string() + ": no such file or folder");
  if (const ImportFormat* known = FormatOf(source, format, true)) return {{source, known->name}};
  if (!fs::is_directory(source, error)) ThrowNothing(source, format);
  std::vector<ForeignSource> found = SearchFolder(source, format);
  if (found.empty()) ThrowNothing(source, format);
  return found;
}

std::vector<ForeignSource> FindObjects(const std::vector<fs::path>& sources,
                                       const std::string& format) {
  if (sources.size() == 1) return FindObjects(sources[0], format);
  if (format != "auto") FormatNamed(format);
  std::vector<ForeignSource> all;
  std::set<fs::path> known;
  for (const fs::path& source : sources) {
    std::vector<ForeignSource> found;
    try {
      found = FindObjects(source, format);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kMissing) throw;
      found = {{source, format}};
    }
    std::error_code ignored;
    for (ForeignSource& object : found) {
      if (known.insert(fs::weakly_canonical(object.path, ignored)).second)
        all.push_back(std::move(object));
    }
  }
  return all;
}

std::vector<ForeignObject> ReadObjects(const ForeignSource& source, const ReadConfig& config) {
  if (!config.allow_missing.empty() && config.allow_missing != "frame")
    throw Error(ErrorCode::kInvalidArgument, "--allow-missing: found \"" + config.allow_missing +
                                                 "\"; only a frame may be missing");
  // nothing was found there: says so again
  if (source.format == "auto" || !fs::exists(source.path))
    return ReadObjects(FindObjects(source.path, source.format).at(0), config);
  return FormatNamed(source.format).read(source.path, config);
}

namespace internal {

std::string PartIdFrom(const std::string& text) {
  constexpr std::size_t kMostOfPartId = 50;
  constexpr std::size_t kDigits = 8;
  std::string id = text;
  for (char& c : id) {
    const bool kept =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    if (!kept) c = '-';
  }
  while (!id.empty() && (id.front() == '.' || id.front() == '-')) id.erase(0, 1);
  if (id.empty()) return "part";
  if (id.size() <= kMostOfPartId) return id;
  // two of them and what stands between make a door's id
  return id.substr(0, kMostOfPartId - kDigits - 1) + "-" + Sha256Hex(text).substr(0, kDigits);
}

Category CategoryOr(const ReadConfig& config, Category otherwise) {
  if (config.category.empty()) return otherwise;
  const std::optional<Category> category = CategoryNamed(config.category);
  if (!category)
    throw Error(ErrorCode::kInvalidArgument,
                "--category: unknown category \"" + config.category +
                    "\"; allowed are interior, window, car, safe, storagefurniture, refrigerator");
  return *category;
}

}  // namespace internal
}  // namespace doorforge
