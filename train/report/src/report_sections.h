// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/report/report_page.h"

// The sections of a report page as HTML. A section without content is an empty string.

namespace doorforge::internal {

bool IsExpert(const EvaluationReport& report);

std::string HeadlineSection(const EvaluationReport& report, const ReportPictures& pictures);
std::string SuccessSection(const EvaluationReport& report);
std::string AngleSection(const EvaluationReport& report);
std::string CauseSection(const EvaluationReport& report, const ReportPictures& pictures);
std::string GraspSection(const ReportPictures& pictures);
std::string DoorSection(const EvaluationReport& report, const ReportPictures& pictures);
std::string SightSection(const ReportPictures& pictures);
std::string LossSection(const EvaluationReport& report);
std::string EpisodeSection(const EvaluationReport& report, const ReportPictures& pictures);
std::string ProvenanceSection(const EvaluationReport& report);

}  // namespace doorforge::internal
