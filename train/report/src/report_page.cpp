// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/report_page.h"

#include "doorforge/core/page_style.h"
#include "doorforge/report/html_numbers.h"

#include "report_sections.h"
#include "report_style.h"

namespace doorforge {

std::string ReportPage(const EvaluationReport& report, const ReportPictures& pictures) {
  using namespace internal;  // NOLINT(google-build-using-namespace): private pieces of this page
  const std::string sections =
      SuccessSection(report) + AngleSection(report) + CauseSection(report, pictures) +
      GraspSection(pictures) + DoorSection(report, pictures) + SightSection(pictures) +
      LossSection(report) + EpisodeSection(report, pictures) + ProvenanceSection(report);
  // the policy keeps even a faulty page from asking the network for anything
  return Fill(
      R"(<!DOCTYPE html>
<html lang="en" xmlns="http://www.w3.org/1999/xhtml">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"/>
<title>doorforge evaluation: {policy}</title>
<style>{style}</style>
</head>
<body>
{headline}
<main>
{sections}
</main>
<footer>Made by doorforge {version}. The same numbers for programs: report.json beside this page.</footer>
<script>{script}</script>
</body>
</html>
)",
      {{"policy", Escape(report.provenance.policy)},
       {"style", std::string(kPageStyle) + std::string(kReportStyle)},
       {"headline", HeadlineSection(report, pictures)},
       {"sections", sections},
       {"version", Escape(report.provenance.code_version)},
       {"script", std::string(kReportScript)}});
}

}  // namespace doorforge
