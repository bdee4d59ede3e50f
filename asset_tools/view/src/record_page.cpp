// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/view/record_page.h"

#include <optional>

#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/physics/robot_model.h"

#include "html_page.h"
#include "record_view.h"
#include "robot_view.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = internal::PageContent::Json;

std::vector<ValidationReport> Validated(std::span<const fs::path> folders, int threads) {
  const DoorValidator validator;
  std::vector<ValidationReport> reports(folders.size());
  Progress progress("validating", folders.size());
  ParallelFor(folders.size(), threads, [&](std::size_t i) {
    reports[i] = validator.Validate(folders[i]);
    progress.Advance();
  });
  return reports;
}

struct Shown {
  Json record;
  std::vector<std::string> faults;
};

Shown ShowDoor(const fs::path& folder, const RobotModel& robot, internal::PageContent& content) {
  auto [door, faults] = internal::ReadDoorForView(folder);
  Shown shown{internal::DoorForView(door, internal::AllMeshes(content), content),
              std::move(faults)};
  shown.record["gripper"] = internal::GripperForView(robot, door.grasp_half_extent_m, content);
  return shown;
}

Shown ShowPart(const fs::path& folder, const RobotModel& robot, internal::PageContent& content) {
  auto [part, faults] = internal::ReadPartForView(folder);
  Shown shown{internal::PartForView(part, internal::AllMeshes(content)), std::move(faults)};
  if (part.role == PartRole::kHandle)
    shown.record["gripper"] = internal::GripperForView(robot, part.grasp_half_extent_m, content);
  return shown;
}

std::string TitleOf(const Json& records) {
  const std::string first = records[0]["id"];
  return records.size() == 1 ? first
                             : first + " and " + std::to_string(records.size() - 1) + " more";
}

}  // namespace

ViewPage MakeRecordPage(std::span<const fs::path> folders, const RecordPageConfig& config) {
  const RobotModel robot = LoadMobileFranka();
  const std::vector<ValidationReport> reports = Validated(folders, config.threads);
  internal::PageContent content;
  content.document["kind"] = "records";
  content.document["version"] = CodeVersion();
  Json records = Json::array();
  ViewPage page;
  page.shown = folders.size();
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const bool is_door = fs::exists(folders[i] / "door.json");
    Shown shown =
        is_door ? ShowDoor(folders[i], robot, content) : ShowPart(folders[i], robot, content);
    shown.record["faults"] = shown.faults;
    internal::AddFindings(reports[i].findings, shown.record);
    page.faults.insert(page.faults.end(), shown.faults.begin(), shown.faults.end());
    records.push_back(std::move(shown.record));
  }
  const std::string title = TitleOf(records);
  content.document["records"] = std::move(records);
  page.html = internal::HtmlPage(title + " - doorforge", content);
  return page;
}

}  // namespace doorforge
