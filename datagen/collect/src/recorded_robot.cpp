// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "recorded_robot.h"

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

bool IsBelow(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path inside =
      fs::weakly_canonical(file, error).lexically_relative(fs::weakly_canonical(folder, error));
  return !error && !inside.empty() && *inside.begin() != "..";
}

}  // namespace

std::string RecordedRobot(const fs::path& dataset, const std::string& recorded,
                          const std::string& given) {
  if (!given.empty()) return given;
  if (recorded.empty() || IsBelow(dataset, recorded)) return recorded;
  throw Error(ErrorCode::kInvalidArgument,
              (dataset / "config.yaml").string() + ": names the robot \"" + recorded +
                  "\", which is not in the dataset's folder; pass --robot " + recorded +
                  " if that is the file you mean");
}

}  // namespace doorforge
