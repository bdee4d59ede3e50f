// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "example_pictures.h"

#include <array>

namespace doorforge {
namespace {

// a PNG of one grey pixel, written out byte by byte
constexpr std::array<unsigned char, 67> kPixel = {
    0x89, 'P',  'N',  'G',  0x0d, 0x0a, 0x1a, 0x0a, 0,    0,    0,    13,   'I',  'H',
    'D',  'R',  0,    0,    0,    1,    0,    0,    0,    1,    8,    0,    0,    0,
    0,    0x3a, 0x7e, 0x9b, 0x55, 0,    0,    0,    10,   'I',  'D',  'A',  'T',  0x78,
    0x9c, 0x63, 0x68, 0,    0,    0,    0x82, 0,    0x81, 0x77, 0xcd, 0x72, 0xb6, 0,
    0,    0,    0,    'I',  'E',  'N',  'D',  0xae, 0x42, 0x60, 0x82};

}  // namespace

ReportPictures ExamplePictures(const EvaluationReport& report) {
  const std::string png(kPixel.begin(), kPixel.end());
  ReportPictures pictures;
  for (const auto* doors : {&report.doors, &report.training_doors}) {
    for (const DoorIdentity& door : *doors) pictures.doors[door.id] = png;
  }
  for (int i = 0; i < kEpisodeOutcomeCount; ++i)
    pictures.episodes[static_cast<EpisodeOutcome>(i)] = {
        {{png, "start <0 s> & \"more\""}, {png, "end"}}, "the 'first' one"};
  pictures.grasps = {{Category::kInterior, true, {png, "on <the> handle"}},
                     {Category::kInterior, false, {png, "beside it"}}};
  pictures.scene = pictures.depth = pictures.cloud = {png, "what the camera sees"};
  return pictures;
}

int PictureCount(const EvaluationReport& report) {
  int count = static_cast<int>(report.doors.size() + report.training_doors.size()) + 3 + 2;
  for (const int outcomes : Summarise(report.episodes).outcomes) count += outcomes > 0 ? 2 : 0;
  return count;
}

}  // namespace doorforge
