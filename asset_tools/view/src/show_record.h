// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/physics/robot_model.h"

#include "page_content.h"

namespace doorforge::internal {

/// A door or part as a page shows it, without findings, and the messages of its damaged meshes.
struct ShownRecord {
  PageContent::Json record;
  std::vector<std::string> faults;
};

/// Throws as ReadDoor() and ReadPart() where the record itself cannot be read.
ShownRecord ShowRecord(const std::filesystem::path& folder, const RobotModel& robot,
                       PageContent& content);

}  // namespace doorforge::internal
