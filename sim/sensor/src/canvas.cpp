// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "stroke_font.h"

namespace doorforge::internal {
namespace {

constexpr double kUnitsOfCapital = 6;  // of the strokes' grid
constexpr double kUnitsBetween = 1.8;
constexpr double kBaseline = 2;  // row of the grid
constexpr double kStrokeWidth = 1.15;

double WidthOf(std::string_view strokes) {
  char widest = '0';
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (strokes[i] == ' ') continue;
    widest = std::max(widest, strokes[i]);
    ++i;  // what follows is the row
  }
  return strokes.empty() ? 2 : widest - '0';
}

struct Segment {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

double DistanceTo(const Segment& line, const Eigen::Vector2d& place) {
  const Eigen::Vector2d along = line.to - line.from;
  const double squared = std::max(along.squaredNorm(), 1e-12);
  const double share = std::clamp((place - line.from).dot(along) / squared, 0.0, 1.0);
  return (place - line.from - share * along).norm();
}

// A letter's strokes with the pen at its left end on the baseline.
std::vector<Segment> LinesOf(std::string_view strokes, const Eigen::Vector2d& pen, double unit) {
  const auto place = [&](std::size_t i) -> Eigen::Vector2d {
    return pen + unit * Eigen::Vector2d(strokes[i] - '0', kBaseline - (strokes[i + 1] - '0'));
  };
  std::vector<Segment> lines;
  for (std::size_t i = 0; i + 3 < strokes.size();) {
    const bool is_end = strokes[i + 2] == ' ';
    if (!is_end) lines.push_back({place(i), place(i + 2)});
    i += is_end ? 3 : 2;
  }
  return lines;
}

// The share of each source pixel in one of the target, along one axis.
struct Shares {
  std::size_t first = 0;
  std::vector<double> share;
};

std::vector<Shares> SharesOf(int from, int to) {
  const double step = static_cast<double>(from) / to;
  const double reach = std::max(1.0, step);
  std::vector<Shares> all(static_cast<std::size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double center = (i + 0.5) * step - 0.5;
    const int first = std::max(0, static_cast<int>(std::ceil(center - reach)));
    const int last = std::min(from - 1, static_cast<int>(std::floor(center + reach)));
    Shares& shares = all[static_cast<std::size_t>(i)];
    shares.first = static_cast<std::size_t>(first);
    double sum = 0;
    for (int j = first; j <= last; ++j) {
      shares.share.push_back(std::max(0.0, 1 - std::abs(j - center) / reach));
      sum += shares.share.back();
    }
    for (double& share : shares.share) share /= sum;
  }
  return all;
}

std::uint8_t Rounded(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

}  // namespace

Canvas::Canvas(int width, int height, const Color& ground) : picture_{width, height, {}} {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture_.rgb.reserve(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    picture_.rgb.insert(picture_.rgb.end(), ground.begin(), ground.end());
}

// Mixes the colour into the pixels of a box; the distance is below 0 within what is drawn.
template <class Distance>
void Canvas::Blend(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Color& color,
                   Distance&& distance) {
  const auto bound = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  const int left = bound(low.x() - 1, picture_.width);
  const int right = bound(high.x() + 2, picture_.width);
  const int bottom = bound(high.y() + 2, picture_.height);
  for (int y = bound(low.y() - 1, picture_.height); y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const double cover = std::clamp(0.5 - distance(Eigen::Vector2d(x + 0.5, y + 0.5)), 0.0, 1.0);
      if (cover <= 0) continue;
      std::uint8_t* pixel =
          &picture_
               .rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) +
                         static_cast<std::size_t>(x))];
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = Rounded(pixel[c] + cover * (color[c] - pixel[c]));
    }
  }
}

void Canvas::Disc(const Eigen::Vector2d& center, double radius, const Color& color) {
  const Eigen::Vector2d reach(radius, radius);
  Blend(center - reach, center + reach, color,
        [&](const Eigen::Vector2d& place) { return (place - center).norm() - radius; });
}

void Canvas::Ring(const Eigen::Vector2d& center, double radius, double width, const Color& color) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius + width / 2);
  Blend(center - reach, center + reach, color, [&](const Eigen::Vector2d& place) {
    return std::abs((place - center).norm() - radius) - width / 2;
  });
}

void Canvas::Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width,
                  const Color& color) {
  const Segment line{from, to};
  const Eigen::Vector2d reach(width / 2, width / 2);
  Blend(from.cwiseMin(to) - reach, from.cwiseMax(to) + reach, color,
        [&](const Eigen::Vector2d& place) { return DistanceTo(line, place) - width / 2; });
}

// A letter at a time, so that the strokes that meet in it are no darker there.
void Canvas::Text(std::string_view text, const Eigen::Vector2d& left_of_baseline,
                  double capital_height, const Color& color) {
  const double unit = capital_height / kUnitsOfCapital;
  Eigen::Vector2d pen = left_of_baseline;
  for (const char letter : text) {
    const std::vector<Segment> lines = LinesOf(StrokesOf(letter), pen, unit);
    const double width = unit * (WidthOf(StrokesOf(letter)) + kUnitsBetween);
    Blend(pen - Eigen::Vector2d(1, 7 * unit + 1), pen + Eigen::Vector2d(width + 1, 2 * unit + 1),
          color, [&](const Eigen::Vector2d& place) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const Segment& line : lines) nearest = std::min(nearest, DistanceTo(line, place));
            return nearest - kStrokeWidth / 2;
          });
    pen.x() += width;
  }
}

void Canvas::Paste(const Picture& picture, int left, int top) {
  const auto row_bytes = 3 * static_cast<std::size_t>(picture.width);
  for (int y = 0; y < picture.height; ++y) {
    const auto from = picture.rgb.begin() + static_cast<std::ptrdiff_t>(row_bytes) * y;
    const auto place = (static_cast<std::ptrdiff_t>(top) + y) * picture_.width + left;
    std::copy_n(from, row_bytes, picture_.rgb.begin() + 3 * place);
  }
}

double TextWidth(std::string_view text, double capital_height) {
  double units = 0;
  for (const char letter : text) units += WidthOf(StrokesOf(letter)) + kUnitsBetween;
  return text.empty() ? 0 : (units - kUnitsBetween) * capital_height / kUnitsOfCapital;
}

Picture Resized(const Picture& picture, int width, int height) {
  const std::vector<Shares> columns = SharesOf(picture.width, width);
  const std::vector<Shares> rows = SharesOf(picture.height, height);
  const auto from_width = static_cast<std::size_t>(picture.width);
  std::vector<double> narrow;  // columns first
  narrow.reserve(3 * static_cast<std::size_t>(picture.height) * columns.size());
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    for (const Shares& column : columns) {
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (std::size_t k = 0; k < column.share.size(); ++k)
          sum += column.share[k] * picture.rgb[3 * (y * from_width + column.first + k) + c];
        narrow.push_back(sum);
      }
    }
  }
  Picture result{width, height, {}};
  result.rgb.reserve(3 * rows.size() * columns.size());
  for (const Shares& row : rows) {
    for (std::size_t i = 0; i < 3 * columns.size(); ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < row.share.size(); ++k)
        sum += row.share[k] * narrow[(row.first + k) * 3 * columns.size() + i];
      result.rgb.push_back(Rounded(sum));
    }
  }
  return result;
}

Color Viridis(double share) {
  constexpr std::array<Color, 16> kSteps = {{{68, 1, 84},
                                             {72, 26, 108},
                                             {71, 47, 125},
                                             {65, 68, 135},
                                             {57, 86, 140},
                                             {49, 104, 142},
                                             {42, 120, 142},
                                             {35, 136, 142},
                                             {31, 152, 139},
                                             {34, 168, 132},
                                             {53, 183, 121},
                                             {84, 197, 104},
                                             {122, 209, 81},
                                             {165, 219, 54},
                                             {210, 226, 27},
                                             {253, 231, 37}}};
  const double place = std::clamp(share, 0.0, 1.0) * (kSteps.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kSteps.size() - 2);
  const double rest = place - static_cast<double>(below);
  Color color{};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = Rounded((1 - rest) * kSteps[below][c] + rest * kSteps[below + 1][c]);
  return color;
}

}  // namespace doorforge::internal
