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
#include "show_record.h"

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
    internal::ShownRecord shown = internal::ShowRecord(folders[i], robot, content);
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
