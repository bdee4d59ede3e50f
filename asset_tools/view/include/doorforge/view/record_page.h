// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "doorforge/view/view_page.h"

namespace doorforge {

/// How doors and parts are shown.
struct RecordPageConfig {
  int threads = 0;  ///< 0: all processors.
};

/// Shows the doors and parts in the folders, of which there is at least one: all that their records
/// say, their meshes and convex pieces, the latch, and what `doorforge validate` finds by the
/// profile "physics". A record of which meshes are damaged or missing is shown without them and
/// with the fault. docs/design/view.md says what a page holds.
///
/// @throws Error as ReadDoor() and ReadPart() where a record itself cannot be read; Error(kMissing)
///     where the viewer is not among the data.
ViewPage MakeRecordPage(std::span<const std::filesystem::path> folders,
                        const RecordPageConfig& config = {});

}  // namespace doorforge
