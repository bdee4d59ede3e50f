// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "doorforge/foreign/validate_foreign.h"
#include "doorforge/foreign/validation_run.h"
#include "doorforge/view/view_page.h"

namespace doorforge {

/// How much a page of findings draws.
struct FindingsPageConfig {
  ForeignChecks checks = {};              ///< Files from outside were judged with them.
  std::size_t most_drawn = 40;            ///< Items, those with findings first.
  std::size_t most_triangles = 60'000;    ///< Of one file from outside; more is drawn coarser.
  std::size_t all_triangles = 1'200'000;  ///< Of all files from outside; those after are listed.
};

/// Shows reports of validation, of which there may be none: every item with its findings, and each
/// finding at its place on the object in 3D, with a number that is in the list beside it. Doors and
/// parts are shown as MakeRecordPage() does. Items that are not drawn, or drawn coarser, say so;
/// they are no faults of the page. Deterministic.
///
/// @throws Error(kMissing) where the viewer is not among the data.
ViewPage MakeFindingsPage(std::span<const ReportedItem> items,
                          const FindingsPageConfig& config = {});

/// The page as RunValidation() takes it, of files that were judged with these checks.
FindingsPage PageOfFindings(const ForeignChecks& checks);

}  // namespace doorforge
