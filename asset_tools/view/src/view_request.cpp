// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/view/view_request.h"

#include "doorforge/core/error.h"
#include "doorforge/validate/validate_door.h"
#include "doorforge/view/episode_page.h"
#include "doorforge/view/gallery_page.h"
#include "doorforge/view/record_page.h"
#include "doorforge/view/report_films_page.h"

namespace doorforge {
namespace {

ViewPage PageOfDataset(const ViewRequest& request) {
  Require(request.paths.size() == 1, ErrorCode::kInvalidArgument, "--doors: is of one data set");
  return MakeDatasetPage({.dataset = request.paths[0],
                          .doors = request.doors,
                          .stage = request.stage,
                          .key = request.key,
                          .most = request.episodes,
                          .points = request.points,
                          .threads = request.threads,
                          .robot = request.robot,
                          .films = request.films});
}

}  // namespace

ViewPage MakeViewPage(const ViewRequest& request) {
  if (request.paths.size() == 1 && IsReport(request.paths[0]))
    return MakeReportPage({request.paths[0], request.doors, request.robot, request.threads});
  if (!request.doors.empty()) return PageOfDataset(request);
  const std::vector<std::filesystem::path> folders = FindRecords(request.paths);
  if (request.episode)
    return MakeExpertPage(folders, {.seed = request.seed,
                                    .points = request.points,
                                    .threads = request.threads,
                                    .robot = request.robot});
  if (request.gallery || folders.size() > kMostInOneList)
    return MakeGalleryPage(folders, {.threads = request.threads});
  return MakeRecordPage(folders, {.threads = request.threads});
}

}  // namespace doorforge
