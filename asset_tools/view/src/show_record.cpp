// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "show_record.h"

#include "record_view.h"
#include "robot_view.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

ShownRecord ShowDoor(const fs::path& folder, const RobotModel& robot, PageContent& content) {
  auto [door, faults] = ReadDoorForView(folder);
  ShownRecord shown{DoorForView(door, AllMeshes(content), content), std::move(faults)};
  shown.record["gripper"] = GripperForView(robot, door.grasp_half_extent_m, content);
  return shown;
}

ShownRecord ShowPart(const fs::path& folder, const RobotModel& robot, PageContent& content) {
  auto [part, faults] = ReadPartForView(folder);
  ShownRecord shown{PartForView(part, AllMeshes(content)), std::move(faults)};
  if (part.role == PartRole::kHandle)
    shown.record["gripper"] = GripperForView(robot, part.grasp_half_extent_m, content);
  return shown;
}

}  // namespace

ShownRecord ShowRecord(const fs::path& folder, const RobotModel& robot, PageContent& content) {
  ShownRecord shown = fs::exists(folder / "door.json") ? ShowDoor(folder, robot, content)
                                                       : ShowPart(folder, robot, content);
  shown.record["faults"] = shown.faults;
  return shown;
}

}  // namespace doorforge::internal
