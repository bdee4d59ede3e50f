// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "measure/distance_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "doorforge/mesh/work_budget.h"

namespace doorforge {
namespace {

constexpr float kFar = 1e20F;  // squared cells; finite, so that differences stay numbers

// Lower envelope of parabolas along one line: Felzenszwalb and Huttenlocher, "Distance Transforms
// of Sampled Functions" (2012).
class LineTransform {
 public:
  explicit LineTransform(int longest)
      : value_(static_cast<std::size_t>(longest)),
        apex_(static_cast<std::size_t>(longest)),
        border_(static_cast<std::size_t>(longest) + 1) {}

  void Apply(float* first, std::size_t stride, int count) {
    for (int i = 0; i < count; ++i)
      value_[static_cast<std::size_t>(i)] = first[stride * static_cast<std::size_t>(i)];
    int last = 0;
    apex_[0] = 0;
    border_[0] = -std::numeric_limits<double>::infinity();
    border_[1] = std::numeric_limits<double>::infinity();
    for (int q = 1; q < count; ++q) {
      double meeting = Meeting(q, apex_[static_cast<std::size_t>(last)]);
      while (meeting <= border_[static_cast<std::size_t>(last)])
        meeting = Meeting(q, apex_[static_cast<std::size_t>(--last)]);
      ++last;
      apex_[static_cast<std::size_t>(last)] = q;
      border_[static_cast<std::size_t>(last)] = meeting;
      border_[static_cast<std::size_t>(last) + 1] = std::numeric_limits<double>::infinity();
    }
    int at = 0;
    for (int q = 0; q < count; ++q) {
      while (border_[static_cast<std::size_t>(at) + 1] < q) ++at;
      const int apex = apex_[static_cast<std::size_t>(at)];
      const auto offset = static_cast<float>(q - apex);
      first[stride * static_cast<std::size_t>(q)] =
          std::min(kFar, offset * offset + value_[static_cast<std::size_t>(apex)]);
    }
  }

 private:
  double Meeting(int q, int p) const {
    const double fq = value_[static_cast<std::size_t>(q)];
    const double fp = value_[static_cast<std::size_t>(p)];
    return ((fq + static_cast<double>(q) * q) - (fp + static_cast<double>(p) * p)) /
           (2.0 * (q - p));
  }

  std::vector<float> value_;
  std::vector<int> apex_;
  std::vector<double> border_;
};

}  // namespace

DistanceGrid::DistanceGrid(const ClosedMesh& mesh, double cell_m)
    : grid_(GridOver(mesh.mesh(), cell_m, 0)), distance_m_(grid_.count(), kFar) {
  MarkInside(mesh.mesh());
  MarkSurface(mesh.mesh());
  SpreadDistances();
  FindLargest();
}

void DistanceGrid::MarkInside(const TriangleMesh& mesh) {
  const auto rows = RowCrossings(mesh, grid_);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const int j = static_cast<int>(r) % grid_.size.y();
    const int k = static_cast<int>(r) / grid_.size.y();
    int winding = 0;
    std::size_t next = 0;
    for (int i = 0; i < grid_.size.x(); ++i) {
      const double x = grid_.CenterOf(i, j, k).x();
      for (; next < rows[r].size() && rows[r][next].x_m <= x; ++next)
        winding += rows[r][next].winding;
      if (winding > 0) distance_m_[grid_.IndexOf(i, j, k)] = 0;
    }
  }
}

// Cells that the surface passes through count as well, or a sheet thinner than a cell would vanish.
void DistanceGrid::MarkSurface(const TriangleMesh& mesh) {
  const double step_m = 0.5 * grid_.cell_m;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> p;
    for (int k = 0; k < 3; ++k)
      p[static_cast<std::size_t>(k)] = mesh.vertices[static_cast<std::size_t>(t[k])];
    // from the corner opposite the shortest edge, so that needles take few points
    for (int turn = 0;
         turn < 2 && (p[1] - p[2]).squaredNorm() >
                         std::min((p[0] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm());
         ++turn)
      std::rotate(p.begin(), p.begin() + 1, p.end());
    const double longest = std::max((p[1] - p[0]).norm(), (p[2] - p[0]).norm());
    const int along = 1 + static_cast<int>(longest / step_m);
    for (int u = 0; u <= along; ++u) {
      const double share = static_cast<double>(u) / along;
      const Eigen::Vector3d from = p[0] + share * (p[1] - p[0]);
      const Eigen::Vector3d way = share * (p[2] - p[1]);
      const int across = 1 + static_cast<int>(way.norm() / step_m);
      CheckWork(static_cast<unsigned>(across));
      for (int v = 0; v <= across; ++v) {
        const Eigen::Vector3i index = grid_.CellAt(from + way * v / across);
        distance_m_[grid_.IndexOf(index.x(), index.y(), index.z())] = 0;
      }
    }
  }
}

void DistanceGrid::SpreadDistances() {
  LineTransform line(grid_.size.maxCoeff());
  const auto nx = static_cast<std::size_t>(grid_.size.x());
  const auto ny = static_cast<std::size_t>(grid_.size.y());
  float* first = distance_m_.data();
  for (int k = 0; k < grid_.size.z(); ++k) {
    CheckWork(static_cast<unsigned>(nx * ny));
    for (int j = 0; j < grid_.size.y(); ++j)
      line.Apply(first + grid_.IndexOf(0, j, k), 1, grid_.size.x());
    for (int i = 0; i < grid_.size.x(); ++i)
      line.Apply(first + grid_.IndexOf(i, 0, k), nx, grid_.size.y());
  }
  for (int j = 0; j < grid_.size.y(); ++j) {
    for (int i = 0; i < grid_.size.x(); ++i)
      line.Apply(first + grid_.IndexOf(i, j, 0), nx * ny, grid_.size.z());
  }
  const auto cell = static_cast<float>(grid_.cell_m);
  for (float& distance : distance_m_) distance = cell * std::sqrt(distance);
}

void DistanceGrid::FindLargest() {
  for (int level = 1; BlocksAt(level - 1).maxCoeff() > 1; ++level) {
    CheckWork();
    const Eigen::Vector3i below = BlocksAt(level - 1);
    Blocks blocks{BlocksAt(level), {}};
    blocks.value_m.resize(blocks.IndexOf(0, 0, blocks.size.z()));
    const float* value = level == 1 ? distance_m_.data() : largest_m_.back().value_m.data();
    for (int k = 0; k < below.z(); ++k) {
      for (int j = 0; j < below.y(); ++j) {
        float* largest = &blocks.value_m[blocks.IndexOf(0, j / 2, k / 2)];
        for (int i = 0; i < below.x(); ++i, ++value)
          largest[i / 2] = std::max(largest[i / 2], *value);
      }
    }
    largest_m_.push_back(std::move(blocks));
  }
}

}  // namespace doorforge
