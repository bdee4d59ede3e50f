// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/cloud_geometry.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "doorforge/core/error.h"
#include "doorforge/networks/point_operators.h"

namespace doorforge {
namespace {

using Indices = std::vector<std::uint16_t>;

void SortUnique(Indices& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

// Replaces indices of a level by their rows in `kept`, which is ascending and holds all of them.
void ToRows(const Indices& kept, Indices& indices) {
  std::vector<std::uint16_t> row(kept.empty() ? 0 : kept.back() + std::size_t{1});
  for (std::size_t i = 0; i < kept.size(); ++i) row[kept[i]] = static_cast<std::uint16_t>(i);
  for (std::uint16_t& index : indices) index = row[index];
}

float SquaredDistance(const PointColumns& points, std::size_t a, std::size_t b) {
  const float dx = points.x[a] - points.x[b];
  const float dy = points.y[a] - points.y[b];
  const float dz = points.z[a] - points.z[b];
  return dx * dx + dy * dy + dz * dz;
}

// The points of the window in their order, so that point 0 stays the first.
Indices InWindow(const PointColumns& points, float radius_m) {
  Indices inside(points.size());
  std::iota(inside.begin(), inside.end(), std::uint16_t{0});
  if (radius_m <= 0) return inside;
  std::vector<float> distance(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) distance[i] = SquaredDistance(points, 0, i);
  std::vector<float> sorted = distance;
  const auto needed = sorted.begin() + (kSetAbstractions[0].points - 1);
  std::nth_element(sorted.begin(), needed, sorted.end());
  const float limit = std::max(radius_m * radius_m, *needed);
  std::erase_if(inside, [&](std::uint16_t i) { return distance[i] > limit; });
  return inside;
}

void Magnify(PointColumns& points, float point_scale) {
  if (point_scale == 1) return;
  for (auto* coordinates : {&points.x, &points.y, &points.z}) {
    for (float& coordinate : *coordinates) coordinate *= point_scale;
  }
}

// Where the outputs are among the points of the window.
Indices OutputsInside(const Indices& inside, std::span<const std::uint16_t> outputs) {
  Indices rows;
  for (const std::uint16_t output : outputs) {
    const auto found = std::lower_bound(inside.begin(), inside.end(), output);
    Require(found != inside.end() && *found == output, ErrorCode::kInvalidArgument,
            "an output point must be in the cloud's window");
    rows.push_back(static_cast<std::uint16_t>(std::distance(inside.begin(), found)));
  }
  return rows;
}

// The targets of each level: the outputs, and upwards their three nearest. Fills skip, neighbour
// and weight with indices into whole levels; the last entry returned are the level 4 points needed.
std::array<Indices, 5> PlanUpsampling(const std::array<PointColumns, 5>& points,
                                      std::span<const std::uint16_t> outputs,
                                      CloudGeometry& geometry) {
  std::array<Indices, 5> targets;
  targets[0].assign(outputs.begin(), outputs.end());
  for (std::size_t level = 0; level < 4; ++level) {
    CloudGeometry::Upsampling& upsampling = geometry.upsampling[level];
    upsampling.skip = targets[level];
    for (const std::uint16_t target : targets[level]) {
      const NearestThree nearest = ThreeNearest(points[level + 1], points[level][target]);
      std::copy(nearest.index.begin(), nearest.index.end(),
                std::back_inserter(upsampling.neighbour));
      std::copy(nearest.weight.begin(), nearest.weight.end(),
                std::back_inserter(upsampling.weight));
    }
    targets[level + 1] = upsampling.neighbour;
    SortUnique(targets[level + 1]);
    ToRows(targets[level + 1], upsampling.neighbour);
  }
  return targets;
}

// Balls of the centres `kept`, with indices into the whole level below.
CloudGeometry::Level BallsOf(const PointColumns& below, const PointColumns& centres,
                             const Indices& kept, const SetAbstractionShape& shape,
                             InstructionSet set) {
  CloudGeometry::Level out;
  out.centre_xyz.reserve(3 * kept.size());
  out.ball_begin.reserve(kept.size() + 1);
  out.ball_begin.push_back(0);
  for (const std::uint16_t index : kept) {
    const std::array<float, 3> centre = centres[index];
    const Indices ball = PointsWithin(below, centre, shape.radius_m, shape.samples, set);
    out.centre_xyz.insert(out.centre_xyz.end(), centre.begin(), centre.end());
    out.member.insert(out.member.end(), ball.begin(), ball.end());
    out.ball_begin.push_back(static_cast<std::uint32_t>(out.member.size()));
  }
  out.member.shrink_to_fit();  // geometries are kept by the thousand
  return out;
}

// The window's points and, of each level above, all; the window's indices in the cloud.
struct SampledLevels {
  Indices inside;
  std::array<PointColumns, 5> points;
};

SampledLevels SampleLevels(const CloudView& cloud, const CloudWindow& window, InstructionSet set) {
  const std::span<const float> xyz = cloud.xyz;
  Require(xyz.size() == std::size_t{3} * kCloudPoints, ErrorCode::kInvalidArgument,
          "a cloud must hold 4096 points, found " + std::to_string(xyz.size() / 3));
  Require(std::all_of(xyz.begin(), xyz.end(), [](float v) { return std::isfinite(v); }),
          ErrorCode::kInvalidArgument, "a cloud must hold finite numbers");
  Require(cloud.rgb.empty() || cloud.rgb.size() == xyz.size(), ErrorCode::kInvalidArgument,
          "a cloud must have a colour for each of its points");
  SampledLevels levels;
  std::array<PointColumns, 5>& points = levels.points;
  points[0] = ToColumns(xyz, window.centre);
  levels.inside = InWindow(points[0], window.crop_radius_m);
  points[0] = points[0].Select(levels.inside);
  Magnify(points[0], window.point_scale);
  for (std::size_t level = 0; level < 4; ++level) {
    points[level + 1] =
        points[level].Select(FarthestPoints(points[level], kSetAbstractions[level].points, set));
  }
  return levels;
}

// What the features of the window's points `outputs` depend on.
CloudGeometry GeometryOf(const std::array<PointColumns, 5>& points, const Indices& outputs,
                         InstructionSet set) {
  CloudGeometry geometry;
  geometry.xyz.reserve(3 * points[0].size());
  for (std::size_t i = 0; i < points[0].size(); ++i) {
    const std::array<float, 3> point = points[0][i];
    geometry.xyz.insert(geometry.xyz.end(), point.begin(), point.end());
  }
  // from the coarsest level down: a level keeps what the one above and the upsampling read
  std::array<Indices, 5> kept = PlanUpsampling(points, outputs, geometry);
  for (std::size_t level = 4; level-- > 0;) {
    geometry.levels[level] =
        BallsOf(points[level], points[level + 1], kept[level + 1], kSetAbstractions[level], set);
    if (level == 0) break;
    Indices& members = geometry.levels[level].member;
    kept[level].insert(kept[level].end(), members.begin(), members.end());
    SortUnique(kept[level]);
    ToRows(kept[level], members);
    ToRows(kept[level], geometry.upsampling[level].skip);
  }
  return geometry;
}

std::vector<std::uint8_t> ColorsInside(const CloudView& cloud, const Indices& inside) {
  std::vector<std::uint8_t> rgb;
  if (cloud.rgb.empty()) return rgb;
  rgb.reserve(3 * inside.size());
  for (const std::uint16_t point : inside) {
    const auto color = cloud.rgb.subspan(std::size_t{3} * point, 3);
    rgb.insert(rgb.end(), color.begin(), color.end());
  }
  return rgb;
}

}  // namespace

CloudGeometry BuildGeometry(const CloudView& cloud, const CloudWindow& window,
                            std::span<const std::uint16_t> outputs, InstructionSet set) {
  const SampledLevels levels = SampleLevels(cloud, window, set);
  CloudGeometry geometry = GeometryOf(levels.points, OutputsInside(levels.inside, outputs), set);
  geometry.rgb = ColorsInside(cloud, levels.inside);
  return geometry;
}

CloudGeometry BuildWholeGeometry(const CloudView& cloud, const CloudWindow& window,
                                 std::span<const std::uint16_t> outputs, InstructionSet set) {
  const SampledLevels levels = SampleLevels(cloud, window, set);
  Indices all(levels.inside.size());
  std::iota(all.begin(), all.end(), std::uint16_t{0});
  // every centre of a level is a point of the level below, whose own nearest it is: none is left
  // out
  CloudGeometry geometry = GeometryOf(levels.points, all, set);
  geometry.read = OutputsInside(levels.inside, outputs);
  geometry.rgb = ColorsInside(cloud, levels.inside);
  return geometry;
}

CloudGeometry BuildGeometry(const CloudView& cloud, const CloudWindow& window) {
  constexpr std::array<std::uint16_t, 1> kPointZero = {0};
  return BuildGeometry(cloud, window, kPointZero, BestInstructionSet());
}

}  // namespace doorforge
