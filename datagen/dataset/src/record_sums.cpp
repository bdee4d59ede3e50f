// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "record_sums.h"

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirst = "# sha256 of the lines below: ";
constexpr std::size_t kHashDigits = 64;
constexpr std::uint64_t kMostBytes = 1 << 20;

std::string Text(const std::map<std::string, std::string>& sums) {
  std::string lines;
  for (const auto& [record, sha256] : sums) lines += sha256 + "  " + record + "\n";
  return std::string(kFirst) + Sha256Hex(lines) + "\n" + lines;
}

// Takes "HASH  NAME\n" off the front; what is no such line stays out of the result, and is noticed
// when the text is made again.
std::map<std::string, std::string> SumsIn(std::string_view text) {
  std::map<std::string, std::string> sums;
  text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (line.size() > kHashDigits + 2)
      sums[std::string(line.substr(kHashDigits + 2))] = line.substr(0, kHashDigits);
  }
  return sums;
}

}  // namespace

RecordSums RecordSums::Read(const fs::path& folder) {
  const fs::path path = folder / kFileName;
  const std::string text = ReadFile(path, kMostBytes);
  RecordSums sums;
  if (!text.empty()) sums.sums_ = SumsIn(text);
  if (Text(sums.sums_) != text)
    throw Error(ErrorCode::kFormat, path.string() +
                                        ": damaged: its lines are not what its first line says; "
                                        "give the datagen command again, or dataset merge");
  return sums;
}

RecordSums RecordSums::ReadOrEmpty(const fs::path& folder) {
  try {
    return Read(folder);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kMissing && error.code() != ErrorCode::kFormat) throw;
    return {};
  }
}

void RecordSums::Set(const std::string& record, std::string_view content) {
  sums_[record] = Sha256Hex(content);
}

bool RecordSums::Lists(const std::string& record, std::string_view content) const {
  const auto found = sums_.find(record);
  return found != sums_.end() && found->second == Sha256Hex(content);
}

void RecordSums::Commit(FileSystem& files, const fs::path& folder) const {
  const fs::path path = folder / kFileName;
  const std::string text = Text(sums_);
  if (!fs::exists(path) || ReadFile(path) != text) CommitFile(files, path, text);
}

}  // namespace doorforge
