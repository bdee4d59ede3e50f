// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "doorforge/report/report.h"

namespace doorforge {

/// A PNG file's bytes, and what it shows.
struct ReportPicture {
  std::string png;      ///< Empty: there is no picture; the page leaves its place out.
  std::string caption;  ///< Plain text, UTF-8.
};

/// Pictures of one episode in the order of time.
struct ReportFilm {
  std::vector<ReportPicture> frames;
  std::string caption;  ///< Plain text, UTF-8.
};

/// Where a trained grasper took hold in an episode, and how sure it was of which places.
struct ReportGrasp {
  Category category = Category::kInterior;
  bool opened = false;
  ReportPicture picture;
};

/// Pictures of a report. All of them are optional.
struct ReportPictures {
  std::map<std::string, std::string> doors;       ///< PNG by id, of doors and training doors.
  std::map<EpisodeOutcome, ReportFilm> episodes;  ///< An episode for each way to end.
  std::vector<ReportGrasp> grasps;  ///< Each category has one that opened before one that failed.
  ReportPicture scene;              ///< What the policy's camera looks at, shaded.
  ReportPicture depth;              ///< It shows the depth image.
  std::set<std::string> filmed;     ///< FilmAddress() of the rows that films.html beside has.
  ReportPicture cloud;              ///< It shows the cloud, coloured by label.
};

/// The report as one HTML page for people: success per category with intervals, success over the
/// door angle, causes of failure, chosen grasps, doors, what the policy saw, losses, every episode,
/// provenance.
///
/// The page is complete in itself (pictures as data URIs, charts as SVG, no request to anywhere),
/// opens from a file, reads without scripts, follows the reader's dark or light setting, and is
/// well-formed XML too. Same arguments, same bytes.
std::string ReportPage(const EvaluationReport& report, const ReportPictures& pictures);

}  // namespace doorforge
