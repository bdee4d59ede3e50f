// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/view/robot_source.h"
#include "doorforge/view/view_page.h"

namespace doorforge {

/// More doors and parts than this are shown as a gallery.
inline constexpr std::size_t kMostInOneList = 40;

/// What is to be shown on one page, as a user names it.
struct ViewRequest {
  /// Folders of doors and parts, or folders that hold some; or one data set; or one report.
  std::vector<std::string> paths;
  std::vector<std::filesystem::path> doors;  ///< Folders with the doors of a data set or report.
  std::string stage;                         ///< A data set shows it; empty: all of its stages.
  std::string key;         ///< A data set shows this one episode; empty: the first ones.
  int episodes = 12;       ///< A data set shows at most so many.
  std::string films;       ///< A data set may have a file of its films; may be empty.
  int points = 1024;       ///< Each cloud of an episode shows so many; 0: none.
  bool gallery = false;    ///< Few doors and parts are a gallery, too.
  bool episode = false;    ///< The expert opens each door.
  std::uint64_t seed = 1;  ///< The expert's scene is drawn with it.
  int threads = 0;         ///< 0: all processors.
  ShownRobot robot = {};
};

/// Makes the page that fits what the paths are: that of a report, else with `doors` that of a data
/// set, else with `episode` the expert's, else a list of doors and parts or a gallery of them.
///
/// @throws Error(kInvalidArgument) if `doors` are given and there are several paths;
/// Error(kMissing)
///     if a path holds neither door nor part; else as the page's function.
ViewPage MakeViewPage(const ViewRequest& request);

}  // namespace doorforge
