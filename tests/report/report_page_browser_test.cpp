// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/program.h"
#include "doorforge/report/report_page.h"

#include "example_pictures.h"
#include "example_report.h"

namespace doorforge {
namespace {

int OpenInBrowser(const std::string& name, const std::string& page) {
  const std::filesystem::path path = std::filesystem::path(DOORFORGE_BINARY_DIR) / name;
  CommitFile(path, page);
  return RunChild({PYTHON, DOORFORGE_SOURCE_DIR "/tests/report/browser_check.py", path.string()});
}

TEST(ReportPageInBrowser, ShowsContentWithoutAMessageInTheConsole) {
  const EvaluationReport report = ExampleReport();
  const int code = OpenInBrowser("browser.html", ReportPage(report, ExamplePictures(report)));
  if (code == 77) GTEST_SKIP() << "needs chromium";
  EXPECT_EQ(code, 0);
}

// the check itself must be able to fail
TEST(ReportPageInBrowser, AFaultyScriptAndABlankPageAreNoticed) {
  const std::string begin = "<!DOCTYPE html><html><head><title>x</title></head><body>";
  const int code = OpenInBrowser("blank.html", begin + "</body></html>");
  if (code == 77) GTEST_SKIP() << "needs chromium";
  EXPECT_EQ(code, 1);
  std::string page = ReportPage(ExampleReport(), {});
  page.insert(page.find("(function"), "undefinedName();");
  EXPECT_EQ(OpenInBrowser("faulty.html", page), 1);
}

}  // namespace
}  // namespace doorforge
