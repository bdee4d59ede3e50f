// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/report/report_page.h"

namespace doorforge {

/// Small valid pictures for every door and every way to end, and the three of the camera.
ReportPictures ExamplePictures(const EvaluationReport& report);

/// <img> elements that a page of these pictures must have.
int PictureCount(const EvaluationReport& report);

}  // namespace doorforge
