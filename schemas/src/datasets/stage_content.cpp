// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/stage_content.h"

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/schemas/dataset.h"

namespace doorforge {

bool ActsAt(std::string_view trained, std::string_view stage) {
  return trained == stage || (trained == kMotionStage && (stage == "handle" || stage == "open"));
}

std::string StageReadOf(const std::filesystem::path& folder, std::string_view stage) {
  if (stage == kFindStage) return "grasp";
  if (stage != kMotionStage) return std::string(stage);
  return std::filesystem::exists(folder / "handle") ? "handle" : "open";
}

std::string StageContentSha256(std::span<const std::filesystem::path> folders,
                               std::string_view stage) {
  Require(!folders.empty(), ErrorCode::kInvalidArgument, "no data set to read samples from");
  std::string content;
  for (const std::filesystem::path& folder : folders) {
    const std::string read = StageReadOf(folder, stage);
    for (const char* split : {"train", "val"}) {
      if (split == std::string_view("val") && !std::filesystem::exists(folder / read / split))
        continue;
      if (!content.empty()) content += '\n';
      content += DatasetReader(folder, read, split).ContentHash();
    }
  }
  return Sha256Hex(content);
}

}  // namespace doorforge
