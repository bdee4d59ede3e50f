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

constexpr std::uint64_t kMostPixels = 16384;  // what browsers and engines take as a texture

/// What a picture's header says.
struct Extent {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
};

// The bytes must be there; the most significant comes first.
std::uint64_t NumberAt(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t number = 0;
  for (const char byte : bytes.substr(at, size))
    number = number << 8U | static_cast<unsigned char>(byte);
  return number;
}

// ISO/IEC 15948: chunks of length, name, content and checksum, from IHDR to IEND.
std::optional<Extent> PngExtent(std::string_view bytes) {
  constexpr std::size_t kHeader = 33;
  if (bytes.size() < kHeader || bytes.substr(12, 4) != "IHDR") return std::nullopt;
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    if (bytes.substr(at + 4, 4) == "IEND")
      return Extent{NumberAt(bytes, 16, 4), NumberAt(bytes, 20, 4)};
    at += 12 + NumberAt(bytes, at, 4);
  }
  return std::nullopt;
}

// ITU-T T.81: segments, of which a frame's (SOF) has the size, up to the end (EOI).
std::optional<Extent> JpegExtent(std::string_view bytes) {
  if (bytes.rfind("\xff\xd9") == std::string_view::npos) return std::nullopt;
  for (std::size_t at = 2; at + 9 <= bytes.size() && bytes[at] == '\xff';) {
    const auto kind = NumberAt(bytes, at + 1, 1);
    const bool is_frame =
        kind >= 0xC0 && kind <= 0xCF && kind != 0xC4 && kind != 0xC8 && kind != 0xCC;
    if (is_frame) return Extent{NumberAt(bytes, at + 7, 2), NumberAt(bytes, at + 5, 2)};
    // a marker may be filled up with further 0xFF
    at += kind == 0xFF ? 1 : 2 + NumberAt(bytes, at + 2, 2);
  }
  return std::nullopt;
}

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

std::string PictureFault(std::string_view bytes) {
  const bool is_png = bytes.starts_with("\x89PNG\r\n\x1a\n");
  if (!is_png && !bytes.starts_with("\xff\xd8\xff")) return "is no PNG and no JPEG file";
  const std::optional<Extent> extent = is_png ? PngExtent(bytes) : JpegExtent(bytes);
  if (!extent)
    return std::string("is a ") + (is_png ? "PNG" : "JPEG") + " that is damaged or cut off";
  const auto [width, height] = *extent;
  if (width >= 1 && height >= 1 && width <= kMostPixels && height <= kMostPixels) return "";
  return "has " + std::to_string(width) + " x " + std::to_string(height) +
         " pixels; allowed are 1 to " + std::to_string(kMostPixels) + " along a side";
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
  if (const std::string fault = PictureFault(bytes); !fault.empty()) return leave_out(fault);
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
