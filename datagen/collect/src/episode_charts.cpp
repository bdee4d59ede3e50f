// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/episode_charts.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

struct Color {
  std::uint8_t red;
  std::uint8_t green;
  std::uint8_t blue;
};

constexpr int kBinWidth = 12;
constexpr int kChartHeight = 220;

// A picture that is white.
Picture Blank(int width, int height) {
  Picture picture{width, height, {}};
  picture.rgb.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255);
  return picture;
}

void FillRows(Picture& picture, int left, int right, int height, Color color) {
  for (int y = picture.height - height; y < picture.height; ++y) {
    for (int x = left; x < right; ++x) {
      std::uint8_t* pixel =
          &picture.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                            static_cast<std::size_t>(x))];
      pixel[0] = color.red;
      pixel[1] = color.green;
      pixel[2] = color.blue;
    }
  }
}

// Bars of the hinge angles, a thin line every 30 degrees.
Picture HistogramPicture(const AngleHistogram& histogram) {
  Picture picture = Blank(AngleHistogram::kBins * kBinWidth, kChartHeight);
  const std::uint64_t largest = std::max<std::uint64_t>(
      *std::max_element(histogram.counts.begin(), histogram.counts.end()), 1);
  for (int bin = 0; bin < AngleHistogram::kBins; ++bin) {
    if (bin % 6 == 0)
      FillRows(picture, bin * kBinWidth, bin * kBinWidth + 1, kChartHeight, {205, 209, 213});
    const double share = static_cast<double>(histogram.counts[static_cast<std::size_t>(bin)]) /
                         static_cast<double>(largest);
    const int height = static_cast<int>(share * (kChartHeight - 12) + 0.5);
    FillRows(picture, bin * kBinWidth + 2, (bin + 1) * kBinWidth - 1, height, {31, 102, 173});
  }
  FillRows(picture, 0, picture.width, 2, {120, 126, 132});
  return picture;
}

std::string CaptionOf(const std::string& stage, const std::string& name,
                      const EpisodeGroup& group) {
  return stage + " " + name + ", 0 to 120 deg: " + std::to_string(group.succeeded) + " of " +
         std::to_string(group.episodes);
}

}  // namespace

Picture EpisodeCharts(const EpisodeDescription& description) {
  std::vector<Picture> pictures;
  std::vector<std::string> captions;
  for (const StageEpisodes& stage : description.stages) {
    for (const auto& [category, group] : stage.by_category) {
      pictures.push_back(HistogramPicture(group.hinge));
      captions.push_back(CaptionOf(stage.stage, category, group));
    }
  }
  if (pictures.empty())
    throw Error(ErrorCode::kMissing, "the dataset has no episodes, so there is nothing to draw");
  ContactSheetConfig sheet;
  sheet.columns = std::min<int>(3, static_cast<int>(pictures.size()));
  return ContactSheet(pictures, captions, sheet);
}

}  // namespace doorforge
