// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "dropped_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 100;
constexpr std::array<std::string_view, 3> kMeshes = {".stl", ".obj", ".glb"};
constexpr std::array<std::string_view, 4> kBeside = {".mtl", ".png", ".jpg", ".jpeg"};

std::string EndingOf(const std::string& name) {
  std::string ending = fs::path(name).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

bool HasOddCharacter(const std::string& name) {
  return name.find_first_of("/\\*?[]:\"<>|") != std::string::npos ||
         std::ranges::any_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

}  // namespace

void CheckFileName(const std::string& name) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::kInvalidArgument, name.substr(0, kLongestName) + ": " + why);
  };
  if (name.empty() || name.size() > kLongestName) refuse("a file's name has 1 to 100 bytes");
  if (name[0] == '.' || name[0] == '-' || name[0] == '~' || HasOddCharacter(name))
    refuse("no name of a file that can be dropped; rename it to letters and digits");
  const std::string ending = EndingOf(name);
  if (!IsMeshName(name) && std::ranges::find(kBeside, ending) == kBeside.end())
    refuse("only STL, OBJ and GLB are taken, and beside an OBJ its MTL, PNG and JPEG files");
}

bool IsMeshName(const std::string& name) {
  return std::ranges::find(kMeshes, EndingOf(name)) != kMeshes.end();
}

std::string DroppedFiles::Keep(const std::string& bytes) {
  Require(bytes.size() <= kMostFileBytes, ErrorCode::kInvalidArgument,
          "a dropped file may have 64 MiB");
  std::string hash = Sha256Hex(bytes);
  const std::lock_guard lock(mutex_);
  if (kept_.contains(hash)) return hash;
  CommitFile(folder_.path() / hash, bytes);
  turns_.push_back(hash);
  kept_[hash] = {bytes.size(), std::prev(turns_.end())};
  total_ += bytes.size();
  Forget();
  return hash;
}

// The one that came last is kept in any case.
void DroppedFiles::Forget() {
  while (total_ > kMostKeptBytes && turns_.size() > 1) {
    const std::string oldest = turns_.front();
    turns_.pop_front();
    total_ -= kept_.at(oldest).bytes;
    kept_.erase(oldest);
    fs::remove(folder_.path() / oldest);
  }
}

void DroppedFiles::PutInto(const fs::path& folder, const NamedFiles& files) {
  fs::create_directories(folder);
  const std::lock_guard lock(mutex_);
  for (const auto& [name, hash] : files) {
    CheckFileName(name);
    const auto found = kept_.find(hash);
    if (found == kept_.end())
      throw Error(ErrorCode::kMissing, name + ": is no longer kept; drop it again");
    turns_.splice(turns_.end(), turns_, found->second.turn);
    fs::copy_file(folder_.path() / hash, folder / name);
  }
}

}  // namespace doorforge::internal
