// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "files/picture_files.h"

#include <algorithm>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNotes = 8;
constexpr std::size_t kMaxName = 200;

bool Leads(const fs::path& to, const fs::path& from) {
  const fs::path relative = to.lexically_relative(from);
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace

NamedFiles::NamedFiles(const fs::path& mesh, const MeshImportLimits& limits)
    : folder_(fs::weakly_canonical(fs::absolute(mesh).parent_path())),
      root_(limits.files_below.empty() ? folder_ : fs::weakly_canonical(limits.files_below)) {
  if (!Leads(folder_, root_)) root_ = folder_;
}

bool NamedFiles::IsBelow(const fs::path& file) const {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(file, error);
  return !error && Leads(real, root_);
}

std::optional<fs::path> NamedFiles::Find(std::string_view name) const {
  const fs::path relative(name);
  if (relative.empty() || relative.is_absolute() || name.find('\0') != std::string_view::npos)
    return std::nullopt;
  fs::path file = folder_ / relative;
  if (!IsBelow(file)) return std::nullopt;
  return file;
}

bool IsPicture(std::string_view bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n") || bytes.starts_with("\xff\xd8\xff");
}

int PictureFiles::Add(std::string_view name) {
  const auto known = number_of_.find(name);
  if (known != number_of_.end()) return known->second;
  const int number = Open(name);
  number_of_.emplace(name, number);
  return number;
}

int PictureFiles::AddEmbedded(const std::string& name, std::string_view bytes) {
  const auto known = number_of_.find(name);
  if (known != number_of_.end()) return known->second;
  const int number = Keep(name, std::string(bytes));
  number_of_.emplace(name, number);
  return number;
}

int PictureFiles::Open(std::string_view name) {
  std::string portable(name.substr(0, kMaxName));
  std::replace(portable.begin(), portable.end(), '\\', '/');
  const std::string base = portable.substr(portable.rfind('/') + 1);
  for (const std::string& candidate : {portable, base}) {
    const std::optional<fs::path> file = files_.Find(candidate);
    std::error_code error;
    if (!file || !fs::is_regular_file(*file, error)) continue;
    try {
      return Keep(portable, ReadFile(*file, limits_.max_picture_bytes));
    } catch (const Error& problem) {
      Note("texture \"" + portable + "\" left out: " + problem.what());
      return -1;
    }
  }
  Note("texture \"" + portable + "\" left out: no such file inside the folder");
  return -1;
}

int PictureFiles::Keep(const std::string& name, std::string bytes) {
  const auto leave_out = [&](const std::string& why) {
    Note("texture \"" + name + "\" left out: " + why);
    return -1;
  };
  if (!IsPicture(bytes)) return leave_out("is no PNG and no JPEG file");
  if (bytes.size() > limits_.max_picture_bytes)
    return leave_out("more than the " + std::to_string(limits_.max_picture_bytes) +
                     " bytes allowed");
  const auto same = std::find(pictures_.begin(), pictures_.end(), bytes);
  if (same != pictures_.end()) return static_cast<int>(same - pictures_.begin());
  total_bytes_ += bytes.size();
  if (total_bytes_ > limits_.max_file_bytes)
    return leave_out("all together more than the " + std::to_string(limits_.max_file_bytes) +
                     " bytes allowed");
  pictures_.push_back(std::move(bytes));
  return static_cast<int>(pictures_.size()) - 1;
}

void PictureFiles::Note(std::string note) {
  if (notes_.size() < kMaxNotes) notes_.push_back(std::move(note));
}

void PictureFiles::MoveTo(ImportedMesh& mesh) {
  mesh.pictures = std::move(pictures_);
  mesh.notes = std::move(notes_);
}

}  // namespace doorforge
